#include "core/curved/curved_body.hpp"

#include <algorithm>
#include <cmath>

#include "core/numerics/error_constants.hpp"
#include "core/pose.hpp"
#include "core/shapes.hpp"

namespace clearance {
namespace {

bool is_extent(double length) noexcept {
  return length >= 0.5 * kLeastExtent && length <= kLargestCoordinate;
}
bool is_radius(double length) noexcept { return length >= 0.0 && length <= kLargestCoordinate; }

CurvedShapeError bad(const char* what) {
  return {std::string(what) + " has to be a length from 1e-12 to 1e12 m"};
}

}  // namespace

CurvedShapeResult ellipsoid(const Vec3& semi_axes, double radius) {
  for (const double axis : semi_axes) {
    if (!is_extent(axis)) return bad("an ellipsoid's semi-axis");
  }
  if (!is_radius(radius)) return CurvedShapeError{"a radius has to be from 0 to 1e12 m"};
  CurvedBody body;
  body.kind = CurvedBody::Kind::kEllipsoid;
  body.semi_axes = semi_axes;
  body.reach = semi_axes.maxCoeff();
  body.radius = radius;
  return body;
}

CurvedShapeResult truncated_cone(double lower_radius, double upper_radius, double half_length,
                                 double radius) {
  if (!is_extent(half_length)) return bad("half the length");
  if (!is_extent(std::max(lower_radius, upper_radius))) return bad("the radius of the larger disc");
  if (!is_radius(std::min(lower_radius, upper_radius)) || !is_radius(radius)) {
    return CurvedShapeError{"a radius has to be from 0 to 1e12 m"};
  }
  CurvedBody body;
  body.kind = CurvedBody::Kind::kTruncatedCone;
  body.discs = {Disc{-half_length, lower_radius}, Disc{half_length, upper_radius}};
  body.reach = std::hypot(half_length, std::max(lower_radius, upper_radius)) * kRoundedUp;
  body.radius = radius;
  return body;
}

CurvedShapeResult cylinder(double disc_radius, double half_length, double radius) {
  return truncated_cone(disc_radius, disc_radius, half_length, radius);
}

CurvedShapeResult cone(double base_radius, double half_length, double radius) {
  return truncated_cone(base_radius, 0.0, half_length, radius);
}

CurvedBody as_curved(const ConvexPolyhedron& polyhedron) noexcept {
  CurvedBody body;
  body.kind = CurvedBody::Kind::kPolyhedron;
  body.polyhedron = &polyhedron;
  body.reach = polyhedron.bounding_radius;
  body.radius = polyhedron.radius;
  return body;
}

}  // namespace clearance
