#include "monitor/intake/ros_joint_trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "monitor/wire/joint_names.hpp"
#include "monitor/wire/moveit_types.hpp"

namespace clearance {
namespace {

double seconds_of(const builtin_interfaces_msg_dds__Duration_& duration) {
  return static_cast<double>(duration.sec) + 1e-9 * static_cast<double>(duration.nanosec);
}

// The names of the robots whose joint states are in the innermost namespace of the topic that has
// some, or else those of all robots.
JointNames names_on(std::string_view topic, const Scene& scene) {
  for (std::size_t end = topic.rfind('/'); end != 0 && end != topic.npos;
       end = topic.rfind('/', end - 1)) {
    const std::string joint_states = std::string(topic.substr(0, end)) + "/joint_states";
    if (std::ranges::find(scene.robots, joint_states, &Robot::joint_states) != scene.robots.end())
      return {scene, joint_states};
  }
  return JointNames(scene);
}

// Adds where the joints are before the first point. Returns a sentence if that is not known. So it
// does if a controller may turn a continuous joint to the first point in the other direction.
std::string begin_at_rest(const Scene& scene, const InputState& state,
                          std::span<const double> first, JointTrajectory& motion) {
  for (std::size_t i = 0; i < motion.joints.size(); ++i) {
    const std::string& joint = motion.joints[i];
    const auto found = std::ranges::find(scene.variables, joint, &JointVariable::name);
    const auto at = static_cast<std::size_t>(found - scene.variables.begin());
    if (found == scene.variables.end() || state.joints[at].state != PresentPose::State::kUsable) {
      return fmt::format(
          "found a first point after time 0 and no position of joint '{}' that is good and within "
          "its age limit; expected a point at time 0, or a joint state",
          joint);
    }
    const double position = state.joints[at].position, velocity = state.joints[at].velocity;
    if (!(std::abs(velocity) <= kRestSpeed)) {
      return fmt::format(
          "found a first point after time 0, and joint '{}' {}; expected a point at time 0, or a "
          "joint that rests",
          joint,
          std::isnan(velocity) ? "has no known velocity"
                               : fmt::format("moves at {:.3g} rad/s or m/s", velocity));
    }
    const bool is_limited = std::isfinite(found->upper - found->lower);
    if (!is_limited && !(std::abs(first[i] - position) < std::numbers::pi)) {
      return fmt::format(
          "found a first point after time 0 that is half a turn or more from the position of the "
          "continuous joint '{}', {:.3f} from {:.3f} rad; expected a point at time 0, or a nearer "
          "one",
          joint, first[i], position);
    }
    motion.positions.push_back(position);
  }
  motion.times.push_back(0.0);
  return "";
}

// ns after the tick, from 0 on.
std::int64_t delay_of(const std_msgs_msg_dds__Header_& header, std::int64_t now_ns) {
  const std::int64_t stamp_ns =
      std::int64_t{header.stamp.sec} * 1'000'000'000 + header.stamp.nanosec;
  return std::max<std::int64_t>(0, stamp_ns - now_ns);
}

// The least of the joints that the scene has.
std::int64_t age_limit_of(const JointTrajectory& motion, const Scene& scene) {
  std::int64_t limit_ns = std::numeric_limits<std::int64_t>::max();
  for (const JointVariable& variable : scene.variables) {
    if (std::ranges::find(motion.joints, variable.name) != motion.joints.end())
      limit_ns = std::min(limit_ns, variable.age_limit_ns);
  }
  return limit_ns;
}

}  // namespace

std::variant<JointTrajectory, std::string> motion_of(std::string_view topic,
                                                     std::span<const std::byte> cdr, CdrBytes bytes,
                                                     const Scene& scene, const InputState& state) {
  CdrDecoder decoder;
  Sample<trajectory_msgs_msg_dds__JointTrajectory_> decoded;
  if (!decoder.decode(cdr, decoded, bytes))
    return "found bytes that do not decode; expected a JointTrajectory";
  const trajectory_msgs_msg_dds__JointTrajectory_& message = *decoded;
  JointTrajectory motion;
  const std::uint32_t joints = message.joint_names._length, points = message.points._length;
  if (joints == 0 || points == 0)
    return fmt::format("found {} joints and {} points; expected some of both", joints, points);
  const JointNames names = names_on(topic, scene);
  for (std::uint32_t i = 0; i < joints; ++i) {
    const char* const name = message.joint_names._buffer[i];
    motion.joints.emplace_back(name == nullptr ? "" : name);
    const std::uint32_t variable = names.find(motion.joints.back());
    if (variable < scene.variables.size()) motion.joints.back() = scene.variables[variable].name;
  }
  const auto* const first = message.points._buffer;
  const bool has_velocities = first->velocities._length > 0;
  const std::int64_t delay_ns = delay_of(message.header, state.now_ns);
  if (const std::int64_t limit_ns = age_limit_of(motion, scene); delay_ns > limit_ns) {
    return fmt::format(
        "found a header.stamp {:.3f} s ahead; expected 0 for a motion that begins at once, or at "
        "most the age limit of its joints, {:.3f} s",
        1e-9 * static_cast<double>(delay_ns), 1e-9 * static_cast<double>(limit_ns));
  }
  const double delay = 1e-9 * static_cast<double>(delay_ns);
  if (delay + seconds_of(first->time_from_start) > 0.0 && first->positions._length == joints) {
    const std::span<const double> positions(first->positions._buffer, joints);
    std::string reason = begin_at_rest(scene, state, positions, motion);
    if (!reason.empty()) return reason;
    if (has_velocities) motion.velocities.assign(joints, 0.0);
  }
  for (std::uint32_t i = 0; i < points; ++i) {
    const auto& point = first[i];
    if (point.positions._length != joints) {
      return fmt::format("found {} positions in points[{}]; expected {}, one for each joint",
                         point.positions._length, i, joints);
    }
    if (point.velocities._length != (has_velocities ? joints : 0)) {
      return fmt::format(
          "found {} velocities in points[{}]; expected {} in every point, one for each joint, or "
          "none at all",
          point.velocities._length, i, joints);
    }
    if (point.accelerations._length > 0) {
      return fmt::format(
          "found accelerations in points[{}]; expected positions, or positions and velocities. "
          "With accelerations, joints move along polynomials of degree 5",
          i);
    }
    const auto take = [&](const auto& from, std::vector<double>& to) {
      to.insert(to.end(), from._buffer, from._buffer + from._length);
    };
    motion.times.push_back(delay + seconds_of(point.time_from_start));
    take(point.positions, motion.positions);
    if (has_velocities) take(point.velocities, motion.velocities);
  }
  return motion;
}

}  // namespace clearance
