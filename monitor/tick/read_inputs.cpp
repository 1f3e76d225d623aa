#include "monitor/tick/read_inputs.hpp"

#include <algorithm>

namespace clearance {

InputState room_for_inputs(const Scene& scene) {
  std::vector<bool> is_link(scene.objects.size(), false);
  for (const Robot& robot : scene.robots) {
    for (const RobotLink& link : robot.links) {
      if (link.object != RobotLink::kNoObject) is_link[link.object] = true;
    }
  }
  InputState state{.joints = std::vector<PresentJoint>(scene.variables.size()),
                   .joint_ages = std::vector<double>(scene.variables.size(), 0.0),
                   .contacts = std::vector<ContactReport>(contact_pairs(scene).size())};
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    if (!scene.objects[i].fixed && !is_link[i]) state.objects.push_back({.object = i});
  }
  return state;
}

void read_inputs(const Monitor& monitor, InputState& state) noexcept {
  const auto seconds = [](std::int64_t age_ns) {
    return 1e-9 * static_cast<double>(std::max<std::int64_t>(age_ns, 0));
  };
  for (std::uint32_t i = 0; i < state.joints.size(); ++i) {
    state.joints[i] = monitor.present_joint(i);
    state.joint_ages[i] = seconds(monitor.joint_age(i).age_ns);
  }
  for (PresentObject& object : state.objects) {
    object.pose = monitor.present_pose(object.object);
    object.age = seconds(monitor.input_age(object.object).age_ns);
  }
  std::ranges::copy(monitor.contacts(), state.contacts.begin());
}

}  // namespace clearance
