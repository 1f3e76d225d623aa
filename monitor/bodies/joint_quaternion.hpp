// The quaternion of a floating joint, as callers state it.
#pragma once

#include <cmath>

#include "config/scene/robot.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

// Returns 1 if the quaternion has length 1 to within kSampleUnitTolerance, and for a joint of any
// other type. Otherwise it returns the length, and a tick would not know where the joint is.
// `position_of(variable)` may be any number.
template <class PositionOf>
[[nodiscard]] double wrong_length(const RobotJoint& joint, const PositionOf& position_of) {
  if (joint.type != JointType::kFloating) return 1.0;
  const auto entry = [&](std::uint32_t i) {
    return joint.multiplier * position_of(joint.variable + i) + joint.offset;
  };
  const double length = std::hypot(std::hypot(entry(3), entry(4)), std::hypot(entry(5), entry(6)));
  return std::abs(length * length - 1.0) <= 2.0 * kSampleUnitTolerance ? 1.0 : length;
}

}  // namespace clearance
