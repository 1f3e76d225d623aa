// The positions of joints that a question states, and those that it has to state.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/scene/chain_rounding.hpp"
#include "monitor/ask/posture.hpp"
#include "monitor/bodies/joint_quaternion.hpp"
#include "monitor/inputs/joint_batch.hpp"

namespace clearance {
namespace {

// A joint that mimics another may be stated, if it is where the other one moves it. Rad or m.
constexpr double kMimicTolerance = 1e-6;

const RobotJoint* mimic_named(const Scene& scene, const std::string& name) noexcept {
  for (const Robot& robot : scene.robots) {
    for (const RobotJoint& joint : robot.joints) {
      if (joint.name == name && variables_of(joint.type) == 1) return &joint;
    }
  }
  return nullptr;
}

}  // namespace

std::optional<std::string> Posture::take_joints(const Question& question) {
  for (TrackedVariable& variable : variables_) {
    variable.input.has_value = false;
    variable.velocity_known = true;
    variable.velocity = 0.0;
  }
  std::fill(bounds_.begin(), bounds_.end(), VariableBounds());
  for (const std::uint32_t moved : trajectory_.moved()) variables_[moved].input.has_value = true;
  for (const HeldJoint& held : question.held) {
    if (auto text = hold(held)) return text;
  }
  free_variables_.clear();
  if (auto text = set_deviations()) return text;
  for (const StatedJoint& stated : question.joints) {
    if (auto text = set_free(stated, question.others)) return text;
  }
  // Joints that mimic others, once these have positions.
  for (const HeldJoint& held : question.held) {
    if (variable_named(scene_, held.name)) continue;
    const RobotJoint& joint = *mimic_named(scene_, held.name);
    const TrackedVariable& leader = variables_[joint.variable];
    const auto moved = trajectory_.moved();
    const bool moves = std::find(moved.begin(), moved.end(), joint.variable) != moved.end();
    const double follows = joint.multiplier * leader.position + joint.offset;
    if (!leader.input.has_value || moves || std::abs(follows - held.position) > kMimicTolerance)
      return "joint \"" + held.name + "\" mimics joint \"" + scene_.variables[joint.variable].name +
             "\" and is not held where that one moves it";
  }
  return std::nullopt;
}

std::optional<std::string> Posture::hold(const HeldJoint& held) {
  std::uint32_t variable = 0;
  if (variable_named(scene_, held.name) || mimic_named(scene_, held.name) == nullptr)
    return set_variable(held.name, held.position, variable);
  if (!(std::abs(held.position) <= kLargestJoint))
    return "the position of joint \"" + held.name + "\" is not finite, or larger than 1e6";
  return std::nullopt;
}

std::optional<std::string> Posture::set_variable(const std::string& name, double position,
                                                 std::uint32_t& variable) {
  if (!(std::abs(position) <= kLargestJoint))
    return "the position of joint \"" + name + "\" is not finite, or larger than 1e6";
  const auto found = variable_named(scene_, name);
  if (!found) return "the cell has no joint \"" + name + "\"";
  variable = *found;
  if (variables_[variable].input.has_value)
    return "joint \"" + name + "\" is held, and has a position already";
  variables_[variable].input.has_value = true;
  variables_[variable].position = position;
  return std::nullopt;
}

void Posture::leave_out_absent_robots() noexcept {
  absent_robots_.find_left_out(
      scene_, [&](std::uint32_t v) { return variables_[v].input.has_value; },
      [&](std::uint32_t object) { return present_[object] != 0; });
  for (std::uint32_t i = 0; absent_robots_.any() && i < present_.size(); ++i)
    if (is_link(i)) present_[i] = !absent_robots_.is_left_out(robot_of_object_[i]);
  all_present_ = std::ranges::count(present_, 0) == 0;
}

std::optional<std::string> Posture::open_joint() const {
  for (std::uint32_t r = 0; r < scene_.robots.size(); ++r) {
    if (absent_robots_.is_left_out(r)) continue;
    for (const RobotJoint& joint : scene_.robots[r].joints) {
      const std::uint32_t count = variables_of(joint.type);
      for (std::uint32_t v = joint.variable; v < joint.variable + count; ++v) {
        if (!variables_[v].input.has_value) {
          return "joint \"" + scene_.variables[v].name +
                 "\" has no position: the motion moves it, or it is held";
        }
        const auto moved = trajectory_.moved();
        if (count > 1 && std::find(moved.begin(), moved.end(), v) != moved.end()) {
          return "joint \"" + joint.name + "\" is planar or floating: it can only be held";
        }
      }
      const double length =
          wrong_length(joint, [&](std::uint32_t v) { return variables_[v].position; });
      if (length != 1.0)
        return fmt::format("the quaternion of joint \"{}\" has the length {}; expected 1",
                           joint.name, length);
    }
  }
  return std::nullopt;
}

// The same limits as those of joint states. The reaches of chains include those of sliding joints,
// which therefore count between waypoints, too. A stop may end beyond a limit of a turning joint.
std::optional<std::string> Posture::beyond_limits(const Question& question) const {
  const bool is_stop = !question.margins_by_pair.empty();
  for (std::uint32_t r = 0; r < scene_.robots.size(); ++r) {
    if (absent_robots_.is_left_out(r)) continue;
    for (const RobotJoint& joint : scene_.robots[r].joints) {
      const bool slides = joint.type == JointType::kPrismatic;
      if (is_stop && !slides) continue;
      const std::uint32_t end = joint.variable + variables_of(joint.type);
      for (std::uint32_t v = joint.variable; v < end; ++v) {
        const JointVariable& limits = scene_.variables[v];
        const auto is_outside = [&](double position) {
          return (slides && std::abs(position) > kLargestLength) ||
                 position < limits.lower - limits.limit_tolerance ||
                 position > limits.upper + limits.limit_tolerance;
        };
        if (trajectory_.leaves(v, is_outside, variables_[v].position, slides)) {
          return fmt::format("joint \"{}\" leaves its limits, {} to {} {}", limits.name,
                             limits.lower, limits.upper, slides ? "m" : "rad");
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace clearance
