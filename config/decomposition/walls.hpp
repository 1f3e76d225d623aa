// Cuts a solid with flat faces into walls: convex pieces that end in planes of its faces.
//
// An open box has no cut that leaves less open space in the hulls of both sides, so a search for
// the best cut finds none. But the plane of an inner face cuts off a whole wall, which is convex.
#pragma once

#include <optional>
#include <vector>

#include "config/decomposition/piece.hpp"

namespace clearance {

struct Walls {
  std::vector<ConvexCell> cells;   // each holds a convex piece of the solid
  std::optional<ConvexCell> rest;  // holds all else, where that is not convex
};

// `whole` is the cell of a shell. A wall is cut off as long as one is found, the largest first, and
// as long as there are fewer than `most`. Then the cells of the walls grow as far as these stay
// convex. So they overlap where they meet, and hold most triangles whole. A piece counts as convex
// if its hull holds none of the points `open`. Coordinates are rounded, so a triangle beside a
// plane may get lost. If the cells, widened by `margin`, m, do not hold all of the mesh, the rest
// is the whole, and there are no walls.
[[nodiscard]] Walls walls_of(const ConvexCell& whole, const OpenSpace& space,
                             const std::vector<OpenPoint>& open, std::size_t most, double margin);

// Returns the vertices of the mesh in the cell, of its triangles clipped by the cell, and of the
// cell where they lie within the solid. Vertices within rounding of a plane count as on it.
[[nodiscard]] std::vector<Vec3> points_in(const ConvexCell& cell, const OpenSpace& space);

}  // namespace clearance
