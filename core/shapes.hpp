// Checked factories: the only way to make a ConvexPolyhedron.
//
// Combinatorics are decided in exact rational arithmetic on the doubles given; coordinates are
// rounded once at the end. What is not a solid closed convex body is refused with a reason a person
// can act on, and so are lengths beyond 1e100 m. Redundant half-spaces disappear. Load time only:
// allocates, may take milliseconds, never throws.
#pragma once

#include <span>
#include <string>
#include <variant>

#include "core/convex_polyhedron.hpp"

namespace clearance {

// One row n.x <= d; n outward, of any non-zero length (the exact half-space of these four doubles).
struct HalfSpace {
  Vec3 normal;
  double offset;
};

struct ShapeError {
  std::string
      reason;  // e.g. "the half-spaces have no common interior: rows 2 and 5 face each other"
};

using ShapeResult = std::variant<ConvexPolyhedron, ShapeError>;

// The intersection, bounded or not. Refused: non-finite rows, zero normals, empty or flat
// intersections, and no rows at all. A row with zero normal and offset >= 0 is refused too: it says
// nothing.
[[nodiscard]] ShapeResult polyhedron_from_halfspaces(std::span<const HalfSpace> rows);

// The convex hull. Refused: non-finite points, fewer than four, or all in one plane.
[[nodiscard]] ShapeResult polyhedron_from_vertices(std::span<const Vec3> points);

// Centred at the origin, axis-aligned. Refused: a half extent that is not finite and positive.
[[nodiscard]] ShapeResult box(const Vec3& half_extents);

// The base polygon (x, y; any order, its hull is taken) extruded along z from z_low to z_high.
[[nodiscard]] ShapeResult prism(std::span<const Eigen::Vector2d> base, double z_low, double z_high);

// A single point: with a radius, a sphere.
[[nodiscard]] ShapeResult point(const Vec3& position, double radius);

// A segment: with a radius, a capsule. Refused when both ends are equal.
[[nodiscard]] ShapeResult segment(const Vec3& start, const Vec3& end, double radius);

}  // namespace clearance
