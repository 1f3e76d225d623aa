// Convex bodies by their support functions: ellipsoids, truncated cones (cylinders and cones among
// them) and polyhedra, each with an optional radius around it.
//
// The support function h(m) is how far a body reaches along m. Where it is smooth, its gradient is
// the only support point and its second derivative says how that point moves when m turns. Where it
// is not, the body is flat there: a facet, a cap, an edge or a generator. Such a body is split into
// pieces that have no flats, and of which it is the hull: a polyhedron into its vertices, a
// truncated cone into its two discs. h is the greatest of the pieces' support functions.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>

#include "core/convex_polyhedron.hpp"
#include "core/vec.hpp"

namespace clearance {

// x^2 + y^2 <= radius^2 in the plane z = height; of radius 0, a point.
struct Disc {
  double height = 0.0, radius = 0.0;  // m
};

struct CurvedBody {
  enum class Kind : std::uint8_t { kPolyhedron, kEllipsoid, kTruncatedCone };

  Kind kind = Kind::kEllipsoid;
  const ConvexPolyhedron* polyhedron = nullptr;  // not owned
  Vec3 semi_axes = Vec3::Zero();                 // of an ellipsoid around the origin, m
  // Of a truncated cone around the z-axis, the lower one first; it is the hull of both.
  std::array<Disc, 2> discs;
  double reach = 0.0;   // no point is farther from the frame's origin, without the radius, m
  double radius = 0.0;  // the body is all points within this of what is described above, m
};

struct CurvedShapeError {
  std::string reason;
};
using CurvedShapeResult = std::variant<CurvedBody, CurvedShapeError>;

// Refused, as by the factories of core/shapes.hpp: what is not finite, longer than
// kLargestCoordinate or thinner than kLeastExtent. A radius is at least 0.
[[nodiscard]] CurvedShapeResult ellipsoid(const Vec3& semi_axes, double radius = 0.0);
// -half_length <= z <= half_length.
[[nodiscard]] CurvedShapeResult cylinder(double disc_radius, double half_length,
                                         double radius = 0.0);
// The base at z = -half_length, the apex at z = half_length.
[[nodiscard]] CurvedShapeResult cone(double base_radius, double half_length, double radius = 0.0);
// One of both radii may be 0.
[[nodiscard]] CurvedShapeResult truncated_cone(double lower_radius, double upper_radius,
                                               double half_length, double radius = 0.0);
// A bounded polyhedron or a half-space, with its own radius. The polyhedron has to outlive it.
[[nodiscard]] CurvedBody as_curved(const ConvexPolyhedron& polyhedron) noexcept;

}  // namespace clearance
