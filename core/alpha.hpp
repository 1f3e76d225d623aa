// The 'alpha' step: how far a body's point may go before a new facet becomes active (§3.3.1.3,
// §3.6.1).
#pragma once

#include "core/active_side.hpp"

namespace clearance {

struct Alpha {
  double fraction = 1.0;  // of the wanted move, in [0, 1]; 1 means that nothing blocks
  // What is reached there: the facet, the edge or the vertex that becomes the active feature.
  std::int32_t blocking = kNone;
};

// Over the feature's own boundary only: a facet's edges, an edge's ends, and all facets from the
// inside. x lies in the feature, so nothing else can block.
[[nodiscard]] Alpha alpha(const ActiveSide& side, const Vec3& move_in_common) noexcept;

// Makes the move and, where it was blocked, the blocking feature the active one.
void advance(ActiveSide& side, const Vec3& move_in_common, const Alpha& step) noexcept;

}  // namespace clearance
