// A solid convex polyhedron with exact coordinates, from which a ConvexBody is made.
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "core/construction/integer_vector.hpp"
#include "core/convex_body.hpp"
#include "core/shapes.hpp"

namespace clearance::exact {

// Runs from node `start` to node `end` (kNone: to infinity) with facet `left` on its left as seen
// from outside. A full line passes through `start`, which is then no vertex.
struct SolidEdge {
  int start, end;
  int left, right;
  bool full_line = false;
};

// No plane twice, no facet without points of its own, no edge of length zero.
struct Solid {
  std::vector<Integer4> planes;  // facets: n.x <= d as (n, d)
  std::vector<Integer4> nodes;   // homogeneous: vertices, and one point of each full line
  std::vector<Integer3> rays;  // the directions of the recession cone's extreme rays; a line is two
  std::vector<SolidEdge> edges;
  Integer4 interior;  // homogeneous: a point strictly inside
};

// The convex hull of finite points, which need not be vertices; refused when flat.
[[nodiscard]] std::variant<Solid, ShapeError> hull_of(std::span<const Vec3> points);

// The intersection of rows that are finite and whose normals are not zero.
[[nodiscard]] std::variant<Solid, ShapeError> intersection_of(std::span<const HalfSpace> rows);

// Rounds every coordinate once. Refused: a coordinate whose square is not finite, or a direction
// that is to be kept exactly and does not fit into doubles.
[[nodiscard]] ShapeResult rounded_polyhedron(const Solid& solid);

}  // namespace clearance::exact
