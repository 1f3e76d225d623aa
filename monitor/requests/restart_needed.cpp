#include "monitor/requests/restart_needed.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace clearance {
namespace {

bool follows_frames(const Scene& scene) {
  const auto has_frame = [](const auto& each) { return !each.frame.empty(); };
  return std::ranges::any_of(scene.objects, has_frame) ||
         std::ranges::any_of(scene.robots, has_frame, &Robot::base);
}

// Attached objects are robots of the scene that hear no joint states.
bool has_robot(const Scene& scene) {
  return !std::ranges::all_of(scene.robots, &Robot::is_attached);
}

bool same_topics(const Cell& before, const Cell& now) {
  return std::ranges::all_of(kTopicKeys, [&](const TopicKey& key) {
    return before.topics.*key.name == now.topics.*key.name;
  });
}

bool same_ros_outputs(const Cell& before, const Cell& now) {
  return std::ranges::all_of(kRosOutputs, [&](const RosOutput& output) {
    return before.ros.outputs.*output.topic == now.ros.outputs.*output.topic;
  });
}

bool same_moveit_inputs(const Cell& before, const Cell& now) {
  return before.ros.moveit.group == now.ros.moveit.group &&
         std::ranges::all_of(kMoveItInputs, [&](const MoveItInput& input) {
           return before.ros.moveit.*input.topic == now.ros.moveit.*input.topic;
         });
}

// Readers of sensors and the memory of their clouds are made at the start.
bool same_sensors(const Scene& before, const Scene& now) {
  return std::ranges::equal(before.sensors, now.sensors, [](const Sensor& a, const Sensor& b) {
    return a.name == b.name && a.kind == b.kind && a.topic == b.topic &&
           a.camera_info == b.camera_info && a.columns == b.columns && a.rows == b.rows &&
           a.most_points == b.most_points;
  });
}

// A sensor's place may be in a frame of tf, which is then read.
bool places_sensors_by_tf(const Scene& scene) {
  return std::ranges::any_of(scene.sensors, [](const Sensor& sensor) { return sensor.is_on_tf(); });
}

}  // namespace

// Readers of topics are made when the daemon starts.
std::optional<std::string> restart_needed(const Cell& before, const Cell& now) {
  const auto restart = [](const std::string& what) { return what + ", which takes a restart"; };
  const Scene &old = before.scene, &scene = now.scene;
  if (old.name != scene.name)
    return restart(fmt::format("its name changes from '{}' to '{}'", old.name, scene.name));
  if (old.rate_hz != scene.rate_hz)
    return restart(fmt::format("the rate changes from {} to {} Hz", old.rate_hz, scene.rate_hz));
  if (before.domain != now.domain || before.partition != now.partition ||
      before.interface != now.interface) {
    return restart("the domain, partition or interface of 'dds' changes");
  }
  if (!same_topics(before, now)) return restart("names of 'topics' change");
  if (!same_ros_outputs(before, now)) return restart("the outputs of 'ros2' change");
  if (!same_moveit_inputs(before, now)) return restart("MoveIt's messages under 'ros2' change");
  if (before.ros.use_sim_time != now.ros.use_sim_time)
    return restart("'use_sim_time' of 'ros2' changes");
  if (before.ros.trajectories != now.ros.trajectories)
    return restart("the trajectories of 'ros2' change");
  if (!has_robot(old) && has_robot(scene)) return restart("the cell gets its first robot");
  if (!follows_frames(old) && follows_frames(scene))
    return restart("an object or a robot follows a frame of tf, and none did before");
  if (!same_sensors(old, scene)) return restart("names, topics or sizes of 'sensors' change");
  if (!places_sensors_by_tf(old) && places_sensors_by_tf(scene))
    return restart("a sensor stands in a frame of tf, and none did before");
  if (before.commands != now.commands) return restart("'commands' change");
  if (before.questions != now.questions) return restart("'questions' change");
  if (before.capacity != now.capacity) return restart("the 'capacity' changes");
  return std::nullopt;
}

std::optional<std::string> beyond_capacity(const Cell& now, const SceneCapacity& capacity) {
  const auto beyond = [](std::size_t count, std::size_t most, std::string_view what,
                         std::string_view key) -> std::optional<std::string> {
    if (count <= most) return std::nullopt;
    return fmt::format(
        "it has {} {}, and {} are the most that the daemon was started for (capacity: {})", count,
        what, most, key);
  };
  const Scene& scene = now.scene;
  if (auto reason = beyond(scene.objects.size(), capacity.objects, "objects", "objects"))
    return reason;
  if (auto reason =
          beyond(scene.variables.size(), capacity.variables, "joint variables", "objects"))
    return reason;
  if (auto reason = beyond(parts_in(scene), capacity.parts, "parts", "parts")) return reason;
  return beyond(scene.pairs.size(), capacity.pairs, "pairs", "pairs");
}

}  // namespace clearance
