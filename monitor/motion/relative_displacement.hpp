// How far can two objects have come as seen from each other? What rides on the same link hardly
// comes nearer, however fast the link is.
#pragma once

#include "monitor/motion/displacement.hpp"

namespace clearance {

// What a body has done since the last tick.
struct BodyMotion {
  const Pose& before;
  const Pose& now;
  const Motion& motion;  // between the two
  double reach;          // no point of it is farther from its origin, m
};

// No point of either has come farther since the last tick as seen from the other, m, on the way
// there and on the way on from there, both together; infinity: no better than what both have moved
// by. Both were known at the last tick and neither has made a discontinuity.
// monitor/swept/README.md.
[[nodiscard]] double relative_displacement(const BodyMotion& a, const BodyMotion& b) noexcept;

}  // namespace clearance
