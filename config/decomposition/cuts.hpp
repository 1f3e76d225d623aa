// Where a piece of a mesh is best cut in two.
#pragma once

#include <optional>
#include <vector>

#include "config/decomposition/piece.hpp"

namespace clearance {

// Of planes along a mesh's faces, and of others across the piece's and the mesh's axes, the one
// that leaves the least open space in the hulls of the two sides, far from the mesh counting more;
// `spacing` is that of the piece's open points.
// Nothing: no plane has points on either side.
[[nodiscard]] std::optional<HalfSpace> best_cut(const Piece& piece,
                                                const std::vector<HalfSpace>& faces,
                                                double tolerance, double spacing);

}  // namespace clearance
