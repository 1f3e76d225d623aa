#include "monitor/wire/joint_names.hpp"

namespace clearance {

// A variable takes the place of its joint's name.
JointNames::JointNames(const Scene& scene) {
  for (const Robot& robot : scene.robots) {
    for (const RobotJoint& joint : robot.joints) {
      if (!joint.name.empty()) variables_[joint.name] = kUnused;
    }
  }
  for (std::uint32_t i = 0; i < scene.variables.size(); ++i) {
    variables_[scene.variables[i].name] = i;
  }
}

std::uint32_t JointNames::find(std::string_view name) const {
  const auto found = variables_.find(name);
  return found == variables_.end() ? kUnknown : found->second;
}

}  // namespace clearance
