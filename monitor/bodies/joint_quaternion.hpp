// The quaternion of a floating joint, as callers state it.
#pragma once

#include <cmath>

#include "config/scene/robot.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

// Returns its length if the tick would not know where the joint is: it is not 1 to within
// kSampleUnitTolerance. Returns 1 otherwise, and of a joint of any other type.
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
