#include "monitor/requests/present_poses.hpp"

#include <algorithm>
#include <utility>

namespace clearance {

std::optional<AttachedCarrier> carrier_of(const std::string& name, const Scene& scene) {
  for (const Robot& robot : scene.robots) {
    if (!robot.is_attached || robot.links.front().name != name) continue;
    const RobotBase& base = robot.base;
    return AttachedCarrier{base.kind == RobotBase::Kind::kObject
                               ? scene.objects[base.object].name
                               : scene.robots[base.robot].links[base.link].name,
                           base.base_from_root};
  }
  return std::nullopt;
}

const Object* find_object(const Scene& scene, const std::string& name) noexcept {
  const auto found = std::ranges::find(scene.objects, name, &Object::name);
  return found == scene.objects.end() ? nullptr : &*found;
}

std::vector<std::string> with_carriers(const std::vector<std::string>& names, const Scene& scene) {
  std::vector<std::string> all = names;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto carrier = carrier_of(all[i], scene);
    if (carrier && std::ranges::find(all, carrier->name) == all.end()) all.push_back(carrier->name);
  }
  return all;
}

PresentPose pose_in_changed(const std::string& name, const Scene& changed, const Scene& running,
                            const PresentPoses& present) {
  using State = PresentPose::State;
  const Object* const object = find_object(changed, name);
  if (object != nullptr && object->absent) return {.state = State::kAbsent};
  if (object != nullptr && object->fixed)
    return {.state = State::kUsable, .world_from_body = object->world_from_object};
  if (const auto carrier = carrier_of(name, changed)) {
    PresentPose pose = pose_in_changed(carrier->name, changed, running, present);
    pose.world_from_body = compose(pose.world_from_body, carrier->carrier_from_object);
    return pose;
  }
  const auto found = present.find(name);
  if (found == present.end()) return {};
  // A pose from before is none of an object that moves by itself only now.
  const Object* const before = find_object(running, name);
  if (before != nullptr && (before->fixed || carrier_of(name, running))) return {};
  return found->second;
}

std::optional<PresentPoses> present_poses(const std::vector<std::string>& names, const Scene& scene,
                                          TickLoop& loop, const std::atomic<bool>& loop_ended) {
  std::vector<std::string> known;
  std::vector<SceneBody> bodies;
  for (const std::string& name : names) {
    const auto body = find_body(name, scene);
    if (!body) continue;
    known.push_back(name);
    bodies.push_back(*body);
  }
  PresentPoses poses;
  if (bodies.empty()) return poses;
  PoseQuestion question(std::move(bodies));
  if (!loop.ask(question, loop_ended)) return std::nullopt;
  for (std::size_t i = 0; i < known.size(); ++i) poses[known[i]] = question.poses()[i];
  return poses;
}

Pose a_from_b(const Pose& world_from_a, const Pose& world_from_b) {
  const Eigen::Quaterniond back = world_from_a.orientation.normalized().conjugate();
  return {back * (world_from_b.position - world_from_a.position),
          (back * world_from_b.orientation.normalized()).normalized()};
}

std::string why_unusable(const PresentPose& pose) {
  switch (pose.state) {
    case PresentPose::State::kUsable:
      break;
    case PresentPose::State::kUnknown:
      return "no pose of it, or of what carries it, has come";
    case PresentPose::State::kLate:
      return "its last pose is older than its age limit";
    case PresentPose::State::kContradicted:
      return "its poses contradict each other or the cell";
    case PresentPose::State::kAbsent:
      return "it is absent";
  }
  return "";
}

}  // namespace clearance
