#include "monitor/scene_changes/present_poses.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <thread>
#include <utility>

namespace clearance {
namespace {

constexpr std::chrono::microseconds kLookForAnswer{50};

// Links without shapes are no objects.
std::optional<AskedBody> body_of(const std::string& name, const Scene& scene) {
  const auto object = std::ranges::find(scene.objects, name, &Object::name);
  if (object != scene.objects.end())
    return AskedBody{.object = static_cast<std::uint32_t>(object - scene.objects.begin())};
  for (std::uint32_t robot = 0; robot < scene.robots.size(); ++robot) {
    const auto& links = scene.robots[robot].links;
    const auto link = std::ranges::find(links, name, &RobotLink::name);
    if (link == links.end()) continue;
    return AskedBody{
        .is_link = true, .robot = robot, .link = static_cast<std::uint32_t>(link - links.begin())};
  }
  return std::nullopt;
}

}  // namespace

std::optional<PresentPoses> present_poses(const std::vector<std::string>& names, const Scene& scene,
                                          TickLoop& loop, const std::atomic<bool>& loop_ended) {
  std::vector<std::string> known;
  std::vector<AskedBody> bodies;
  for (const std::string& name : names) {
    const auto body = body_of(name, scene);
    if (!body) continue;
    known.push_back(name);
    bodies.push_back(*body);
  }
  PresentPoses poses;
  if (bodies.empty()) return poses;
  PoseQuestion question(std::move(bodies));
  while (!loop.ask(question)) {
    if (loop_ended) return std::nullopt;
    std::this_thread::sleep_for(kLookForAnswer);
  }
  while (!question.is_answered() && !loop_ended) std::this_thread::sleep_for(kLookForAnswer);
  if (!question.is_answered()) {
    loop.take_back(question);
    return std::nullopt;
  }
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
