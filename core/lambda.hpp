// The 'lambda' step: does letting go of an active facet bring the bodies closer? (§3.4.3)
#pragma once

#include "core/active_side.hpp"

namespace clearance {

struct Lambda {
  double rate =
      0.0;  // how fast the point may approach the other, per unit of path: > 0 asks for release
  Feature to = Feature::kInside;  // the feature that remains
  std::int32_t index = kNone;
};

// The release that gains most. `towards` points from this body's x to the other's, common frame.
// The rate is minus the multiplier of the thesis: its three cases (3.4.23) to (3.4.25), the last
// one over all edges that leave the vertex rather than the three of one choice of facets. All rates
// are in the unit of `towards`, so that they can be compared between the bodies, as the scaling of
// (3.4.25) is there for.
[[nodiscard]] Lambda lambda(const ActiveSide& side, const Vec3& towards) noexcept;

}  // namespace clearance
