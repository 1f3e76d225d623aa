#include "config/scene/plausible_joints.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace clearance {
namespace {

bool is_stated(double limit) noexcept { return std::isfinite(limit); }

// True if the variable with this place in its joint is an angle.
bool is_angle(JointType type, std::uint32_t place) noexcept {
  switch (type) {
    case JointType::kRevolute:
    case JointType::kContinuous:
      return true;
    case JointType::kPlanar:
      return place == 2;
    default:
      return false;
  }
}

double default_speed(JointType type, std::uint32_t place, bool is_base) noexcept {
  if (is_angle(type, place)) return kFastestTurnUnstated;
  // An entry of a quaternion changes at most at half the rate of the rotation.
  if (type == JointType::kFloating && place >= 3)
    return 0.5 * (is_base ? kFastestBaseTurn : kFastestTurnUnstated);
  return is_base ? kFastestBase : kFastestSlideUnstated;
}

double tolerance_of(const JointVariable& variable, bool is_angle) noexcept {
  if (!is_stated(variable.lower) || !is_stated(variable.upper)) return 0.0;
  return std::max(kLimitShare * (variable.upper - variable.lower),
                  is_angle ? kLeastAngleTolerance : kLeastLengthTolerance);
}

// After a full turn of this variable, every link is where it was. A joint that mimics it by a
// multiplier that is no integer is not.
bool all_turn_fully(const Robot& robot, std::uint32_t variable) noexcept {
  return std::ranges::all_of(robot.joints, [&](const RobotJoint& joint) {
    return joint.variable != variable || joint.type == JointType::kFixed ||
           (joint.type != JointType::kPrismatic &&
            joint.multiplier == std::nearbyint(joint.multiplier));
  });
}

// A joint that mimics another has the variable of that one, whose name differs.
bool is_of(const RobotJoint& joint, const JointVariable& variable) {
  return variable.name == joint.name || variable.name.starts_with(joint.name + "/");
}

bool may_wrap(JointType type, std::uint32_t place) noexcept {
  return type == JointType::kContinuous || (type == JointType::kPlanar && place == 2);
}

}  // namespace

void set_plausible_motion(Robot& robot, std::vector<JointVariable>& variables) {
  for (const RobotJoint& joint : robot.joints) {
    for (std::uint32_t place = 0; place < variables_of(joint.type); ++place) {
      JointVariable& variable = variables[joint.variable + place];
      if (!is_of(joint, variable)) continue;
      variable.first_of_joint = joint.variable;
      variable.unstated_speed = default_speed(joint.type, place, robot.is_of_base(joint.variable));
      variable.limit_tolerance = tolerance_of(variable, is_angle(joint.type, place));
      if (!may_wrap(joint.type, place)) continue;
      variable.wraps = all_turn_fully(robot, joint.variable + place);
      if (variable.wraps) continue;
      robot.notes.push_back(
          "positions of the continuous joint '" + variable.name +
          "' must not wrap: what mimics it is elsewhere after a full turn of this joint");
    }
  }
}

}  // namespace clearance
