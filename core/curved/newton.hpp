// The direction along which two bodies are farthest apart, by Newton's method with pieces that stay
// the same: from the last direction of a tracked pair, mostly one or two steps.
#pragma once

#include "core/curved/direction_search.hpp"

namespace clearance {

struct NewtonEnd {
  bool tight = false;  // pair.bounds are, and no piece was left out
  int supports = 0;
};

// From n (unit) with these pieces, one to three, whose functions are equal at the best direction. n
// moves on whatever comes of it. Not tight: other pieces count, or the bodies nearly touch, or
// overlap, or rounding leaves the bounds too wide: the search of direction_search.hpp decides.
[[nodiscard]] NewtonEnd refine_direction(CurvedPair& pair, const ActivePieces& active,
                                         Vec3& n) noexcept;

}  // namespace clearance
