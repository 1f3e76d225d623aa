// Finds the pose of a body in the last tick of a monitor, by its name.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "monitor/tick/monitor.hpp"

namespace clearance {

// A body of a scene: an object, or a link without shapes.
struct SceneBody {
  bool is_link = false;
  std::uint32_t object = 0;           // index into Scene::objects
  std::uint32_t robot = 0, link = 0;  // indices into Scene::robots and Robot::links
};

// Returns nothing if no body of the scene has this name.
[[nodiscard]] inline std::optional<SceneBody> find_body(const std::string& name,
                                                        const Scene& scene) {
  const auto object = std::ranges::find(scene.objects, name, &Object::name);
  if (object != scene.objects.end())
    return SceneBody{.object = static_cast<std::uint32_t>(object - scene.objects.begin())};
  for (std::uint32_t robot = 0; robot < scene.robots.size(); ++robot) {
    const auto& links = scene.robots[robot].links;
    const auto link = std::ranges::find(links, name, &RobotLink::name);
    if (link == links.end()) continue;
    return SceneBody{
        .is_link = true, .robot = robot, .link = static_cast<std::uint32_t>(link - links.begin())};
  }
  return std::nullopt;
}

[[nodiscard]] inline PresentPose present_pose(const SceneBody& body,
                                              const Monitor& monitor) noexcept {
  return body.is_link ? monitor.present_link(body.robot, body.link)
                      : monitor.present_pose(body.object);
}

// A pose that a message depends on is not usable now, and is expected back.
struct PoseIsLate : std::runtime_error {
  PoseIsLate() : std::runtime_error("a pose is late, contradicted or not heard yet") {}
};

// Returns the pose of the body of this name. Throws PoseIsLate if the last one is late or
// contradicted, or if it is a link whose joints were not heard yet: a message that depends on it
// waits. Nothing: no pose is expected of it.
[[nodiscard]] inline std::optional<Pose> pose_or_late(const std::string& name, const Scene& scene,
                                                      const PresentPose& pose) {
  using State = PresentPose::State;
  if (pose.state == State::kUsable) return pose.world_from_body;
  const bool was_heard = pose.state == State::kLate || pose.state == State::kContradicted;
  const bool is_link = std::ranges::any_of(scene.robots, [&](const Robot& robot) {
    return std::ranges::find(robot.links, name, &RobotLink::name) != robot.links.end();
  });
  if (was_heard || (is_link && pose.state == State::kUnknown)) throw PoseIsLate();
  return std::nullopt;
}

}  // namespace clearance
