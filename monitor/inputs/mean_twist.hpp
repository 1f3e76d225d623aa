// The velocity between two poses.
#pragma once

#include "core/pose.hpp"

namespace clearance {

// Returns the mean velocity from one pose to the next, m/s and rad/s, with the smaller of the two
// possible rotations. `seconds` is positive.
[[nodiscard]] Twist mean_twist(const Pose& from, const Pose& to, double seconds) noexcept;

}  // namespace clearance
