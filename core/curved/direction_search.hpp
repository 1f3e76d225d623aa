// The direction along which two bodies are farthest apart, by Newton's method on the pieces that
// are active there.
#pragma once

#include "core/curved/curved_pair.hpp"

namespace clearance {

struct DirectionSearchEnd {
  int iterations = 0;
  int supports = 0;
};

// Improves pair.bounds from the direction n on until they are tight or nothing improves them.
DirectionSearchEnd search_direction(CurvedPair& pair, const Vec3& n, ActivePieces& active) noexcept;

}  // namespace clearance
