// How deep two bodies overlap: the least, over all directions, of how far they reach past each
// other.
//
// That function has several minima, so a search from one direction bounds the depth from above
// only. From below it is bounded by triangles of directions that cover the sphere, halved until
// each of them is known to have nothing less, but for a tolerance.
#pragma once

#include "core/curved/curved_pair.hpp"

namespace clearance {

struct DepthBounds {
  double lower = -kInfinity;  // m; the greatest that is known
  int supports = 0;
};

// pair.bounds.lower, minus the depth, is improved to the best that is found.
[[nodiscard]] DepthBounds bound_depth(CurvedPair& pair) noexcept;

}  // namespace clearance
