#include "monitor/requests/present_poses.hpp"

#include <algorithm>
#include <utility>

#include "config/scene/absent_robots.hpp"

namespace clearance {

std::optional<AttachedCarrier> carrier_of(const std::string& name, const Scene& scene) {
  for (const Robot& robot : scene.robots) {
    const RobotBase& base = robot.base;
    if (base.kind == RobotBase::Kind::kWorld || robot.links.front().name != name) continue;
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

const Robot* find_robot(const Scene& scene, const std::string& name) noexcept {
  const auto found = std::ranges::find_if(
      scene.robots, [&](const Robot& robot) { return !robot.is_attached && robot.name == name; });
  return found == scene.robots.end() ? nullptr : &*found;
}

namespace {

// The root of the robot that has this link; nothing: it is the root itself, or no link.
std::optional<std::string> root_above(const std::string& link, const Scene& scene) {
  for (const Robot& robot : scene.robots) {
    if (std::ranges::find(robot.links, link, &RobotLink::name) == robot.links.end()) continue;
    if (robot.links.front().name == link) return std::nullopt;
    return robot.links.front().name;
  }
  return std::nullopt;
}

// Tells whether the base of the robot with this root is in both scenes the same.
bool has_same_base(const std::string& root, const Scene& a, const Scene& b) {
  const auto in_a = carrier_of(root, a), in_b = carrier_of(root, b);
  if (in_a.has_value() != in_b.has_value()) return false;
  if (in_a) {
    return in_a->name == in_b->name &&
           same_pose(in_a->carrier_from_object, in_b->carrier_from_object);
  }
  const auto world_from_root = [&](const Scene& scene) {
    for (const Robot& robot : scene.robots)
      if (robot.links.front().name == root) return robot.base.base_from_root;
    return Pose{};
  };
  return same_pose(world_from_root(a), world_from_root(b));
}

}  // namespace

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
  // Where the links of a robot on another base are follows from joints, which are not read here.
  if (const auto root = root_above(name, changed); root && !has_same_base(*root, changed, running))
    return {};
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
  const std::vector<SceneBody> asked = bodies;
  PoseQuestion question(std::move(bodies));
  if (!loop.ask(question, loop_ended)) return std::nullopt;
  for (std::size_t i = 0; i < known.size(); ++i) {
    poses[known[i]] = question.poses()[i];
    if (asked[i].is_link && is_absent(scene.robots[asked[i].robot], scene.objects))
      poses[known[i]] = {.state = PresentPose::State::kAbsent};
  }
  return poses;
}

std::optional<std::vector<PresentJoint>> present_joints(const Scene& scene, TickLoop& loop,
                                                        const std::atomic<bool>& loop_ended) {
  PoseQuestion question({}, scene.variables.size());
  if (!loop.ask(question, loop_ended)) return std::nullopt;
  return std::vector<PresentJoint>(question.joints().begin(), question.joints().end());
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
      return "its poses contradict each other, the cell or a camera";
    case PresentPose::State::kAbsent:
      return "it is absent";
  }
  return "";
}

}  // namespace clearance
