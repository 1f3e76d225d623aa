#include "config/edit/robot_entry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "config/edit/object_users.hpp"
#include "config/yaml/yaml_writer.hpp"

namespace clearance {
namespace {

// The joints of the robot are read again. What else the cell says of them stays.
void forget_positions(YamlNode& robot) {
  YamlNode* joints = find(robot, "joints");
  if (joints == nullptr) return;
  for (YamlEntry& joint : joints->entries) erase(joint.value, "position");
  std::erase_if(joints->entries, [](const YamlEntry& joint) {
    return joint.value.kind == YamlNode::Kind::kMap && joint.value.entries.empty();
  });
  if (joints->entries.empty()) erase(robot, "joints");
}

void hold(const JointPosition& at, YamlNode& robot) {
  YamlNode joints;
  if (const YamlNode* stated = find(robot, "joints")) joints = *stated;
  YamlNode joint;
  if (const YamlNode* stated = find(joints, at.joint)) joint = *stated;
  set(joint, "position", number_node(at.position));
  set(joints, at.joint, std::move(joint));
  set(robot, "joints", std::move(joints));
}

}  // namespace

std::optional<ChangeFault> move_robot(const AttachRobot& change, YamlNode pose, YamlNode& node) {
  if (const YamlNode* attached = find(node, "attached")) {
    return ChangeFault{fmt::format("robots[{}].attached", change.robot),
                       fmt::format("found '{}', which is attached to '{}'; expected a robot that "
                                   "nothing carries: detach it first",
                                   change.robot, text_of(find(*attached, "to")))};
  }
  for (const char* key : {"base", "absent"}) erase(node, key);
  forget_positions(node);
  YamlNode attached;
  set(attached, "to", text_node(change.to));
  set(attached, "pose", std::move(pose));
  set(node, "attached", std::move(attached));
  return std::nullopt;
}

std::optional<ChangeFault> move_robot(const DetachRobot& change, YamlNode pose, YamlNode& node) {
  if (find(node, "attached") == nullptr) {
    return ChangeFault{fmt::format("robots[{}]", change.robot),
                       fmt::format("found '{}', which is not attached; expected an attached "
                                   "robot",
                                   change.robot)};
  }
  if (change.powered && !change.joints.empty()) {
    return ChangeFault{fmt::format("robots[{}].joints", change.robot),
                       "found joints that stand, and powered: true; expected one of the two"};
  }
  erase(node, "attached");
  YamlNode base;
  set(base, "pose", std::move(pose));
  set(node, "base", std::move(base));
  for (const JointPosition& joint : change.joints) hold(joint, node);
  if (change.absent) set(node, "absent", flag_node(true));
  return std::nullopt;
}

std::optional<ChangeFault> set_body(const std::string& id, const std::string& person,
                                    YamlNode& node) {
  YamlNode* stated = find(node, "person");
  if (stated == nullptr) {
    return ChangeFault{"id", fmt::format("found '{}', which is no person; expected a robot with "
                                         "'person'",
                                         person)};
  }
  set(*stated, "id", text_node(id));
  return std::nullopt;
}

}  // namespace clearance
