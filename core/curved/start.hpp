// The first direction of a search: by GJK, with points of the bodies that stay where they are.
#pragma once

#include "core/curved/curved_pair.hpp"

namespace clearance {

struct CurvedStart {
  Vec3 normal;          // unit, frame A
  bool meet = false;    // the bodies share a point, up to rounding: `bounds` has it
  ActivePieces pieces;  // of the simplex that is nearest to the origin
};

// Ends as soon as a direction is found along which the bodies are at least half as far apart as
// their nearest points are, or when the simplex holds the origin.
[[nodiscard]] CurvedStart start_direction(CurvedPair& pair) noexcept;

}  // namespace clearance
