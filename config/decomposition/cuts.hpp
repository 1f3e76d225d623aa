// Finds the best cut of a piece of a mesh.
#pragma once

#include <optional>
#include <vector>

#include "config/decomposition/piece.hpp"

namespace clearance {

// Returns the plane that leaves the least open space in the hulls of the two sides; space far from
// the mesh counts more. Candidates run along the mesh's faces, and across the axes of the piece and
// of the mesh. `spacing` is that of the piece's open points. Returns nothing when no plane has
// points on either side.
[[nodiscard]] std::optional<HalfSpace> best_cut(const Piece& piece,
                                                const std::vector<HalfSpace>& faces,
                                                double tolerance, double spacing);

}  // namespace clearance
