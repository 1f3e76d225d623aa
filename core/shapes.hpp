// Checked factories: only they make convex bodies.
//
// Combinatorics are decided in exact rational arithmetic on the doubles given; coordinates are
// rounded once at the end. Anything but a solid closed convex body is refused with a reason that a
// person can act on. So are bodies that no scene contains. Limits: coordinates, offsets and radii
// of 1e12 m, extents of 1e-12 m, normals from 1e-100 to 1e100 long. An unbounded body must open by
// at least 1e-6 rad, and by at least that much less than half a turn. Redundant half-spaces
// disappear. Load time only: allocates, may take milliseconds, never throws.
#pragma once

#include <span>
#include <string>
#include <variant>

#include "core/convex_body.hpp"
#include "core/pose.hpp"

namespace clearance {

// A solid is at least this thick along every facet's normal, and a segment at least this long, m.
inline constexpr double kLeastExtent = 1e-12;
inline constexpr double kShortestNormal = 1e-100, kLongestNormal = 1e100;

// One row n.x <= d; n outward, from kShortestNormal to kLongestNormal long (the exact half-space of
// these four doubles).
struct HalfSpace {
  Vec3 normal;
  double offset;
};
static_assert(sizeof(HalfSpace) == 32 && alignof(HalfSpace) == 8);

struct ShapeError {
  std::string
      reason;  // e.g. "the half-spaces have no common interior: rows 2 and 5 face each other"
};

using ShapeResult = std::variant<ConvexBody, ShapeError>;

// The intersection, bounded or not. Refused: non-finite rows, zero normals, empty or flat
// intersections, and no rows at all. A row with zero normal and offset >= 0 is refused too: it says
// nothing.
[[nodiscard]] ShapeResult polyhedron_from_halfspaces(std::span<const HalfSpace> rows);

// The convex hull. Refused: non-finite points, fewer than four, or all in one plane.
[[nodiscard]] ShapeResult polyhedron_from_vertices(std::span<const Vec3> points);

// Centred at the origin, axis-aligned. Refused: a half extent that is not finite and positive.
[[nodiscard]] ShapeResult box(const Vec3& half_extents);

// The base polygon (x, y; any order, its hull is taken) extruded along z from z_low to z_high.
[[nodiscard]] ShapeResult prism(std::span<const Vec2> base, double z_low, double z_high);

// A single point: with a radius, a sphere.
[[nodiscard]] ShapeResult point(const Vec3& position, double radius);

// A segment: with a radius, a capsule. Refused when both ends are equal.
[[nodiscard]] ShapeResult segment(const Vec3& start, const Vec3& end, double radius);

// These doubles define curved bodies exactly. Refused: a length that is not finite, longer than
// kLargestCoordinate or shorter than kLeastExtent. Each body is the set of all points within
// `rounding` (m, >= 0) of the shape described.
//
// Around the origin, along the axes.
[[nodiscard]] ShapeResult ellipsoid(const Vec3& semi_axes, double rounding = 0.0);
// x^2 + y^2 <= radius^2, -half_length <= z <= half_length.
[[nodiscard]] ShapeResult cylinder(double radius, double half_length, double rounding = 0.0);
// The base at z = -half_length, the apex at z = half_length.
[[nodiscard]] ShapeResult cone(double base_radius, double half_length, double rounding = 0.0);
// The hull of a disc at z = -half_length and one at z = half_length; one radius may be 0.
[[nodiscard]] ShapeResult truncated_cone(double lower_radius, double upper_radius,
                                         double half_length, double rounding = 0.0);

// The same body with this radius around it in place of its former radius: a rounded box, hull or
// cylinder. Refused: a radius that is not from 0 to kLargestCoordinate.
[[nodiscard]] ShapeResult rounded_by(double radius, ConvexBody body);

}  // namespace clearance
