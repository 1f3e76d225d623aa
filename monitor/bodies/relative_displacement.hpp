// A bound of the relative displacement of two objects. Two objects on the same link hardly move
// relative to each other, however fast the link is.
#pragma once

#include "monitor/bodies/displacement.hpp"

namespace clearance {

// The motion of a body since the last tick.
struct BodyMotion {
  const Pose& before;
  const Pose& now;
  const Motion& motion;    // between the two
  double bounding_radius;  // around its origin, m
};

// Bounds the displacement since the last tick of any point of either object in the frame of the
// other, m. It covers paths by any pose in between, too. Infinity means no better bound than the
// displacement of both. Both must have been known at the last tick, without a discontinuity since.
// monitor/schedule/SWEPT.md has the proof.
[[nodiscard]] double relative_displacement(const BodyMotion& a, const BodyMotion& b) noexcept;

}  // namespace clearance
