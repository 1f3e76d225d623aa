#include "monitor/intake/ros_joint_trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "monitor/wire/moveit_types.hpp"

namespace clearance {
namespace {

double seconds_of(const builtin_interfaces_msg_dds__Duration_& duration) {
  return static_cast<double>(duration.sec) + 1e-9 * static_cast<double>(duration.nanosec);
}

// Adds where the joints are before the first point. Returns a sentence if that is not known.
std::string begin_at_rest(const Scene& scene, const InputState& state, JointTrajectory& motion) {
  for (const std::string& joint : motion.joints) {
    const auto found = std::ranges::find(scene.variables, joint, &JointVariable::name);
    const auto at = static_cast<std::size_t>(found - scene.variables.begin());
    if (found == scene.variables.end() || state.joints[at].state != PresentPose::State::kUsable) {
      return fmt::format(
          "found a first point after time 0 and no position of joint '{}' that is good and within "
          "its age limit; expected a point at time 0, or a joint state",
          joint);
    }
    motion.positions.push_back(state.joints[at].position);
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

std::variant<JointTrajectory, std::string> motion_of(std::span<const std::byte> cdr, CdrBytes bytes,
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
  for (std::uint32_t i = 0; i < joints; ++i) {
    const char* const name = message.joint_names._buffer[i];
    motion.joints.emplace_back(name == nullptr ? "" : name);
  }
  const auto* const first = message.points._buffer;
  const auto* const last = first + points;
  const bool has_velocities =
      std::all_of(first, last, [&](const auto& each) { return each.velocities._length == joints; });
  const std::int64_t delay_ns = delay_of(message.header, state.now_ns);
  if (const std::int64_t limit_ns = age_limit_of(motion, scene); delay_ns > limit_ns) {
    return fmt::format(
        "found a header.stamp {:.3f} s ahead; expected 0 for a motion that begins at once, or at "
        "most the age limit of its joints, {:.3f} s",
        1e-9 * static_cast<double>(delay_ns), 1e-9 * static_cast<double>(limit_ns));
  }
  const double delay = 1e-9 * static_cast<double>(delay_ns);
  if (delay + seconds_of(first->time_from_start) > 0.0) {
    if (std::string reason = begin_at_rest(scene, state, motion); !reason.empty()) return reason;
    if (has_velocities) motion.velocities.assign(joints, 0.0);
  }
  for (std::uint32_t i = 0; i < points; ++i) {
    const auto& point = first[i];
    if (point.positions._length != joints) {
      return fmt::format("found {} positions in points[{}]; expected {}, one for each joint",
                         point.positions._length, i, joints);
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
