// What changes leave out: where bodies are now, and where joints stand.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "config/text/spelling.hpp"
#include "monitor/requests/scene_commander.hpp"

namespace clearance {
namespace {

// Tells whether a change may put one of these bodies elsewhere, or make it absent.
struct MayMove {
  const std::vector<std::string>& bodies;
  bool operator()(const AddObject&) const { return true; }
  bool operator()(const ReplaceObject&) const { return true; }
  bool operator()(const ReplaceCell&) const { return true; }
  bool operator()(const AddFromTemplate& change) const { return has(change.object); }
  bool operator()(const RemoveObject& change) const { return has(change.object); }
  bool operator()(const SetAbsent& change) const { return has(change.object); }
  bool operator()(const Attach& change) const { return has(change.object); }
  bool operator()(const Detach& change) const { return has(change.object); }
  bool operator()(const Place& change) const { return has(change.object); }
  bool operator()(const AttachRobot&) const { return true; }
  bool operator()(const DetachRobot&) const { return true; }
  template <class Change>
  bool operator()(const Change&) const {
    return false;
  }
  [[nodiscard]] bool has(const std::string& name) const {
    return std::ranges::find(bodies, name) != bodies.end();
  }
};

CommandRefusal no_pose(std::size_t change, const std::string& object, std::string reason) {
  return {CommandStatus::kNoPose, change, fmt::format("objects[{}].pose", object),
          std::move(reason)};
}

// A joint that moves farther within its age limit does not stand, m or rad.
constexpr double kStands = 1e-3;

// Why a joint cannot stand where it is, as the end of a sentence. Empty: it can.
std::string why_not_standing(const JointVariable& variable, const PresentJoint& joint) {
  if (variable.name.find('/') != std::string::npos) return "is one of several of a joint";
  if (joint.state != PresentPose::State::kUsable) return "is not known now";
  const double moves = std::abs(joint.velocity) * 1e-9 * static_cast<double>(variable.age_limit_ns);
  if (moves <= kStands) return "";
  return std::isnan(moves) ? "has no known velocity"
                           : fmt::format("moves by {:.4g} a second", joint.velocity);
}

// A pose that a change leaves out: of this body, in the frame of what carries it, or in the world.
struct LeftOutPose {
  std::string body;
  const std::string* to;  // null: the world
  std::optional<Pose>* pose;
};

// An unknown robot is refused by its name when the change is made.
std::optional<LeftOutPose> pose_in(CellChange& change, const Scene& scene) {
  if (auto* attach = std::get_if<Attach>(&change))
    return LeftOutPose{attach->object, &attach->to, &attach->carrier_from_object};
  if (auto* detach = std::get_if<Detach>(&change))
    return LeftOutPose{detach->object, nullptr, &detach->world_from_object};
  if (auto* attach = std::get_if<AttachRobot>(&change)) {
    if (const Robot* robot = find_robot(scene, attach->robot))
      return LeftOutPose{robot->links.front().name, &attach->to, &attach->carrier_from_root};
  }
  if (auto* detach = std::get_if<DetachRobot>(&change)) {
    if (const Robot* robot = find_robot(scene, detach->robot))
      return LeftOutPose{robot->links.front().name, nullptr, &detach->world_from_root};
  }
  return std::nullopt;
}

}  // namespace

// The pose of a body after the changes before this one, as if they had been made one by one.
std::variant<Pose, CommandRefusal> SceneCommander::pose_of(const std::string& name,
                                                           const Work& work, std::size_t change,
                                                           const PresentPoses& poses) {
  const Scene& running = changer_.cell().scene;
  const auto before = std::span(work.changes).first(change);
  const std::vector<std::string> bodies = with_carriers({name}, running);
  PresentPose pose;
  const auto present = poses.find(name);
  bool is_known = present != poses.end();
  if (is_known) pose = present->second;
  if (std::ranges::any_of(
          before, [&](const CellChange& each) { return std::visit(MayMove{bodies}, each); })) {
    const auto read = editor_->dry_run(before);
    if (const auto* refused = std::get_if<EditRefusal>(&read)) {
      return CommandRefusal{CommandStatus::kRefused, refused->change, refused->path,
                            refused->reason};
    }
    const Scene& changed = std::get<Cell>(read).scene;
    is_known = is_known || find_object(changed, name) != nullptr;
    pose = pose_in_changed(name, changed, running, poses);
  }
  if (!is_known) {
    std::vector<std::string> names;
    for (const Object& object : running.objects) names.push_back(object.name);
    for (const Robot& robot : running.robots) {
      for (const RobotLink& link : robot.links) names.push_back(link.name);
    }
    return CommandRefusal{CommandStatus::kRefused, change, fmt::format("objects[{}]", name),
                          fmt::format("found no object or link '{}' in the scene; expected one{}",
                                      name, did_you_mean(name, names))};
  }
  if (pose.state == PresentPose::State::kUsable) return pose.world_from_body;
  return no_pose(change, name,
                 fmt::format("found that '{}' is not known to be anywhere, since {}; expected a "
                             "pose that is known now, or one in the change",
                             name, why_unusable(pose)));
}

// All poses are of one tick, so that a carrier that moves takes the object with it exactly.
std::optional<PresentPose> SceneCommander::present_pose(const std::string& name) {
  const auto poses = present_poses({name}, cell().scene, loop_, loop_ended_);
  if (!poses || !poses->contains(name)) return std::nullopt;
  return poses->at(name);
}

SceneCommander::Refusal SceneCommander::take_poses(Work& work) {
  const Scene& running = changer_.cell().scene;
  std::vector<std::string> names;
  bool are_stated = true;
  for (CellChange& change : work.changes) {
    const auto left_out = pose_in(change, running);
    if (!left_out) continue;
    names.push_back(left_out->body);
    if (left_out->to != nullptr) names.push_back(*left_out->to);
    are_stated = are_stated && left_out->pose->has_value();
  }
  if (Refusal refusal = take_positions(work)) return refusal;
  if (are_stated) return std::nullopt;
  const auto poses = present_poses(with_carriers(names, running), running, loop_, loop_ended_);
  if (!poses) return CommandRefusal{CommandStatus::kEnding, 0, "", "the daemon ends"};
  for (std::size_t i = 0; i < work.changes.size(); ++i) {
    const auto left_out = pose_in(work.changes[i], running);
    if (!left_out || left_out->pose->has_value()) continue;
    auto body = pose_of(left_out->body, work, i, *poses);
    if (auto* refusal = std::get_if<CommandRefusal>(&body)) return std::move(*refusal);
    if (left_out->to == nullptr) {
      *left_out->pose = std::get<Pose>(body);
      continue;
    }
    auto carrier = pose_of(*left_out->to, work, i, *poses);
    if (auto* refusal = std::get_if<CommandRefusal>(&carrier)) return std::move(*refusal);
    *left_out->pose = a_from_b(std::get<Pose>(carrier), std::get<Pose>(body));
  }
  return std::nullopt;
}

// The joints of a robot that is detached stand where they are now, unless the change states where.
// One that moves would be elsewhere by then, and its links for as long as it stands.
SceneCommander::Refusal SceneCommander::take_positions(Work& work) {
  const Scene& running = changer_.cell().scene;
  for (std::size_t i = 0; i < work.changes.size(); ++i) {
    auto* detach = std::get_if<DetachRobot>(&work.changes[i]);
    const Robot* robot = detach == nullptr ? nullptr : find_robot(running, detach->robot);
    if (robot == nullptr || detach->powered) continue;
    const auto joints = present_joints(running, loop_, loop_ended_);
    if (!joints) return CommandRefusal{CommandStatus::kEnding, 0, "", "the daemon ends"};
    const auto place = static_cast<std::uint32_t>(robot - running.robots.data());
    for (std::size_t v = 0; v < running.variables.size(); ++v) {
      const JointVariable& variable = running.variables[v];
      if (variable.robot != place) continue;
      const std::string name = variable.name.substr(robot->prefix.size());
      if (std::ranges::count(detach->joints, name, &JointPosition::joint) > 0) continue;
      const std::string why = why_not_standing(variable, (*joints)[v]);
      if (why.empty()) {
        detach->joints.push_back({name, (*joints)[v].position});
      } else if (!detach->absent) {
        return CommandRefusal{
            CommandStatus::kNoPose, i, fmt::format("robots[{}].joints", robot->name),
            fmt::format("found that '{}' {}; expected its position in the change (joints), or "
                        "powered: true",
                        name, why)};
      }
    }
  }
  return std::nullopt;
}

}  // namespace clearance
