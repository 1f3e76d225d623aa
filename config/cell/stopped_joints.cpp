#include "config/cell/stopped_joints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace clearance {
namespace {

// A joint that brakes covers at most the distance that it would cover without brakes, and hardly
// less than the first share of it: makers' tables have 0.2 to 0.5. The second one has room for
// noise.
constexpr double kLeastShare = 0.05, kMostShare = 1.05;
// Between its full speed and standstill, s. No brake acts faster, and no drive is slower.
constexpr double kLeastStop = 0.01, kMostRamp = 10.0;

}  // namespace

StoppedJoint* StoppedJoints::named(const std::string& name_or_number) noexcept {
  const auto found = std::ranges::find(all, name_or_number, &StoppedJoint::name);
  if (found != all.end()) return &*found;
  std::size_t number = 0;
  const char* const last = name_or_number.data() + name_or_number.size();
  const auto [end, error] = std::from_chars(name_or_number.data(), last, number);
  const bool is_number = error == std::errc() && end == last;
  return is_number && number >= 1 && number <= all.size() ? &all[number - 1] : nullptr;
}

std::vector<std::string> StoppedJoints::names() const {
  std::vector<std::string> names;
  for (const StoppedJoint& joint : all) names.push_back(joint.name);
  return names;
}

StoppedJoints stopped_joints(const Robot& robot, std::span<const JointVariable> variables) {
  StoppedJoints joints;
  for (const RobotJoint& joint : robot.joints) {
    if (joint.type == JointType::kFixed || robot.is_of_base(joint.variable)) continue;
    if (variables_of(joint.type) != 1) return {.refused = joint.name};
    const JointVariable& variable = variables[joint.variable];
    if (variable.name != joint.name) continue;  // it mimics another
    joints.all.push_back({.name = joint.name.substr(robot.prefix.size()),
                          .variable = joint.variable,
                          .turns = joint.type != JointType::kPrismatic,
                          .full_speed = variable.max_speed,
                          .urdf_acceleration = variable.urdf_acceleration,
                          .urdf_deceleration = variable.urdf_deceleration});
  }
  return joints;
}

std::string doubt_of_point(const StoppedJoint& joint, const StopPoint& point) {
  if (!std::isfinite(joint.full_speed))
    return fmt::format(
        "found a stop of '{}' from a percentage of its speed, which nothing states; expected a "
        "velocity limit in the URDF, or `velocity` under `joints` of the robot",
        joint.name);
  const double unbraked = point.speed * point.time;
  if (point.distance >= kLeastShare * unbraked && point.distance <= kMostShare * unbraked)
    return "";
  const char* unit = joint.unit();
  return fmt::format(
      "found that '{}' stands {:.4g} {} and {:.4g} s after {:.4g} {}/s; expected {:.4g} to {:.4g} "
      "{}, as it goes {:.4g} {} in this time without brakes: is a unit wrong, or its velocity "
      "limit?",
      joint.name, point.distance, unit, point.time, point.speed, unit, kLeastShare * unbraked,
      kMostShare * unbraked, unit, unbraked, unit);
}

std::string doubt_of_deceleration(const StoppedJoint& joint, double deceleration) {
  if (!std::isfinite(joint.full_speed)) return "";
  const double time = joint.full_speed / deceleration;
  if (time >= kLeastStop && time <= kMostRamp) return "";
  return fmt::format(
      "found a deceleration of {:.4g} {}/s2 of '{}', by which it stands {:.3g} s after its full "
      "speed, {:.4g} {}/s; expected from {} to {} s: is a unit wrong?",
      deceleration, joint.unit(), joint.name, time, joint.full_speed, joint.unit(), kLeastStop,
      kMostRamp);
}

std::string doubt_of_acceleration(const StoppedJoint& joint, double acceleration) {
  if (!std::isfinite(joint.full_speed)) return "";
  const double time = joint.full_speed / acceleration;
  if (time <= kMostRamp) return "";
  return fmt::format(
      "found an acceleration of {:.4g} {}/s2 of '{}', which takes {:.3g} s to its full speed, "
      "{:.4g} {}/s; expected at most {} s: is a unit wrong?",
      acceleration, joint.unit(), joint.name, time, joint.full_speed, joint.unit(), kMostRamp);
}

}  // namespace clearance
