// Finds the best cut of a piece of a mesh.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "config/decomposition/piece.hpp"

namespace clearance {

enum class CutChoice : std::uint8_t {
  kLeastOpen,  // the cut that leaves the least open space
  // The same where it gains much. Elsewhere all cuts are alike, as for a ring, and one that is even
  // and short is better: its halves can be cut further.
  kEven,
};

// Returns the plane that leaves the least open space in the hulls of the two sides; space far from
// the mesh counts more. `choice` decides between cuts that gain little. Candidates run along the
// mesh's faces, and across the axes of the piece and of the mesh. `spacing` is that of the piece's
// open points. Returns nothing when no plane has points on either side.
[[nodiscard]] std::optional<HalfSpace> best_cut(const Piece& piece,
                                                const std::vector<HalfSpace>& faces,
                                                CutChoice choice, double tolerance, double spacing);

}  // namespace clearance
