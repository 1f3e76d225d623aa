// How far can two objects have come as seen from each other? Two objects on the same link hardly
// come nearer, however fast the link is.
#pragma once

#include "monitor/motion/displacement.hpp"

namespace clearance {

// The motion of a body since the last tick.
struct BodyMotion {
  const Pose& before;
  const Pose& now;
  const Motion& motion;  // between the two
  double reach;          // no point of it is farther from its origin, m
};

// As seen from the other object, no point of either has come farther since the last tick, m, nor by
// any pose in between. Infinity: no better than the displacement of both. Both were known at the
// last tick, and neither has made a discontinuity. monitor/swept/README.md has the proof.
[[nodiscard]] double relative_displacement(const BodyMotion& a, const BodyMotion& b) noexcept;

}  // namespace clearance
