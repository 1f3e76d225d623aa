#include "monitor/ask/path_frames.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/ask/trajectory.hpp"
#include "monitor/bodies/forward_kinematics.hpp"

namespace clearance {
namespace {

// The segment of the timeline that contains an instant.
Stretch segment_at(const Trajectory& trajectory, double time) {
  std::uint32_t i = 0;
  while (i + 1 < trajectory.segments() && trajectory.segment(i).to < time) ++i;
  return trajectory.segment(i);
}

// By object: a joint with waypoints moves it.
std::vector<bool> moved_links(const Scene& scene, std::span<const std::uint32_t> moved) {
  std::vector<bool> result(scene.objects.size(), false);
  std::vector<std::vector<bool>> by_link;
  for (const Robot& robot : scene.robots) {
    std::vector<bool>& moves = by_link.emplace_back(robot.links.size(), false);
    if (robot.base.kind == RobotBase::Kind::kLink)
      moves[0] = by_link[robot.base.robot][robot.base.link];
    for (std::size_t i = 0; i < robot.joints.size(); ++i) {
      const RobotJoint& joint = robot.joints[i];
      const bool by_joint =
          variables_of(joint.type) > 0 && std::ranges::find(moved, joint.variable) != moved.end();
      moves[i + 1] = moves[joint.parent] || by_joint;
    }
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
      if (robot.links[i].object != RobotLink::kNoObject) result[robot.links[i].object] = moves[i];
    }
  }
  return result;
}

}  // namespace

std::vector<PathFrame> path_frames(const Scene& scene, const Question& question,
                                   std::span<const double> positions,
                                   std::span<const Pose> carriers, std::size_t count,
                                   std::span<const double> more) {
  Trajectory trajectory(scene.variables.size());
  if (trajectory.take(question, scene)) return {};
  std::vector<TrackedVariable> variables(scene.variables.size());
  for (std::size_t i = 0; i < variables.size(); ++i) {
    variables[i].position = positions[i];
    variables[i].input.has_value = std::isfinite(positions[i]);
  }
  for (const HeldJoint& held : question.held) {
    if (const auto variable = variable_named(scene, held.name)) {
      variables[*variable].position = held.position;
      variables[*variable].input.has_value = true;
    }
  }
  for (const std::uint32_t moved : trajectory.moved()) variables[moved].input.has_value = true;
  std::vector<LinkState> bases(scene.robots.size());
  for (std::size_t r = 0; r < bases.size(); ++r) {
    bases[r].known = true;
    bases[r].pose = carriers[r];
  }
  std::vector<double> times(more.begin(), more.end());
  count = std::max<std::size_t>(2, count);
  const double begin = trajectory.begin(), length = trajectory.end() - begin;
  for (std::size_t i = 0; i < count; ++i)
    times.push_back(begin + length * static_cast<double>(i) / static_cast<double>(count - 1));
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());

  const std::vector<bool> is_moved = moved_links(scene, trajectory.moved());
  std::vector<VariableBounds> bounds(scene.variables.size());
  ForwardKinematics kinematics(scene.robots);
  std::vector<PathFrame> frames;
  for (const double time : times) {
    trajectory.place(segment_at(trajectory, time), time, variables, bounds);
    kinematics.place(variables, bases);
    PathFrame& frame = frames.emplace_back();
    frame.time = time;
    for (std::uint32_t r = 0; r < scene.robots.size(); ++r) {
      for (std::size_t i = 0; i < scene.robots[r].links.size(); ++i) {
        const std::uint32_t object = scene.robots[r].links[i].object;
        const LinkState& link = kinematics.links(r)[i];
        if (object != RobotLink::kNoObject && is_moved[object] && link.known)
          frame.links.push_back({object, link.pose});
      }
    }
  }
  return frames;
}

}  // namespace clearance
