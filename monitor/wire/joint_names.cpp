#include "monitor/wire/joint_names.hpp"

#include <algorithm>

namespace clearance {

JointNames::JointNames(const Scene& scene) {
  for (std::uint32_t robot = 0; robot < scene.robots.size(); ++robot) {
    add(scene, robot, Prefix::kKept);
  }
}

// Names with their prefixes come first, because two robots never share one.
JointNames::JointNames(const Scene& scene, std::string_view ros_topic) {
  const bool is_named = std::ranges::any_of(
      scene.robots, [&](const Robot& robot) { return robot.joint_states == ros_topic; });
  const std::string_view topic = is_named ? ros_topic : "";
  for (const Prefix prefix : {Prefix::kKept, Prefix::kLeftOut}) {
    if (prefix == Prefix::kLeftOut && !is_named) break;
    for (std::uint32_t robot = 0; robot < scene.robots.size(); ++robot) {
      if (scene.robots[robot].joint_states == topic) add(scene, robot, prefix);
    }
  }
}

// A variable comes before its joint: both may have one name. A name that is there already keeps its
// variable.
void JointNames::add(const Scene& scene, std::uint32_t robot, Prefix prefix) {
  const auto name_of = [&](const std::string& name) {
    return prefix == Prefix::kKept ? name : name.substr(scene.robots[robot].prefix.size());
  };
  for (std::uint32_t i = 0; i < scene.variables.size(); ++i) {
    const JointVariable& variable = scene.variables[i];
    if (variable.robot == robot)
      variables_.emplace(name_of(variable.name), variable.is_read ? i : kUnused);
  }
  for (const RobotJoint& joint : scene.robots[robot].joints) {
    if (joint.name.size() > scene.robots[robot].prefix.size())
      variables_.emplace(name_of(joint.name), kUnused);
  }
}

std::uint32_t JointNames::find(std::string_view name) const {
  const auto found = variables_.find(name);
  return found == variables_.end() ? kUnknown : found->second;
}

}  // namespace clearance
