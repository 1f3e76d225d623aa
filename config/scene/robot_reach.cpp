#include "config/scene/robot_reach.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace clearance {
namespace {

// The largest distance of a joint's child from the joint's own frame, m; infinite: without limits.
double travel(const RobotJoint& joint, const std::vector<JointVariable>& variables) {
  switch (joint.type) {
    case JointType::kFixed:
    case JointType::kRevolute:
    case JointType::kContinuous:
      return 0.0;
    case JointType::kPrismatic: {
      const JointVariable& of = variables[joint.variable];
      const auto at = [&](double position) {
        return std::abs(joint.multiplier * position + joint.offset);
      };
      return std::max(at(of.lower), at(of.upper)) + std::abs(joint.multiplier) * of.limit_tolerance;
    }
    case JointType::kPlanar:
    case JointType::kFloating:
      return kInfinity;
  }
  return kInfinity;
}

double radius_of(const Object& object) {
  double radius = 0.0;
  for (const Part& part : object.parts) {
    radius = std::max(radius, part.object_from_part.position.norm() + part.shape.bounding_radius +
                                  part.shape.radius + part.shape.position_error);
  }
  return radius;
}

bool follows_a_frame(const Robot& robot) { return !robot.base.frame.empty(); }

// The ball without its radius: around the base of this robot.
ReachBall ball_around(const Robot& robot, std::uint32_t index) {
  ReachBall ball;
  ball.is_carried = robot.base.kind == RobotBase::Kind::kObject || follows_a_frame(robot);
  ball.centre = robot.base.base_from_root.position;
  ball.robot = index;
  ball.link = follows_a_frame(robot) ? 1 : 0;
  return ball;
}

// The distance of the root of `robot` from the root of the first robot, m; infinite: it changes.
double distance_of_roots(const Robot& first, const Robot& robot) {
  if (follows_a_frame(first) || follows_a_frame(robot)) return kInfinity;
  if (first.base.kind != robot.base.kind) return kInfinity;
  if (robot.base.kind == RobotBase::Kind::kObject && first.base.object != robot.base.object)
    return kInfinity;
  return (robot.base.base_from_root.position - first.base.base_from_root.position).norm();
}

}  // namespace

std::variant<ReachBall, std::string> robots_reach(const Scene& scene) {
  // By robot and link: the distance from the centre, which is the base of the first robot.
  std::vector<std::vector<double>> reach(scene.robots.size());
  const Robot* first = nullptr;
  ReachBall ball;
  for (std::size_t i = 0; i < scene.robots.size(); ++i) {
    const Robot& robot = scene.robots[i];
    const RobotBase& base = robot.base;
    const bool is_on_link = base.kind == RobotBase::Kind::kLink;
    if (first == nullptr && !is_on_link && !robot.is_attached) {
      first = &robot;
      ball = ball_around(robot, static_cast<std::uint32_t>(i));
    }
    double root = kInfinity;
    if (is_on_link) {
      root = reach[base.robot][base.link] + base.base_from_root.position.norm();
    } else if (first == &robot) {
      root = 0.0;
    } else if (first != nullptr) {
      root = distance_of_roots(*first, robot);
    }
    reach[i].assign(robot.links.size(), kInfinity);
    reach[i][0] = root;
    for (std::size_t joint = 0; joint < robot.joints.size(); ++joint) {
      const RobotJoint& of = robot.joints[joint];
      const bool is_of_base = joint == 0 && follows_a_frame(robot);
      reach[i][joint + 1] = is_of_base
                                ? root
                                : reach[i][of.parent] + of.parent_from_joint.position.norm() +
                                      travel(of, scene.variables);
    }
    for (std::size_t link = 0; link < robot.links.size(); ++link) {
      if (robot.links[link].object == RobotLink::kNoObject) continue;
      const double radius = reach[i][link] + radius_of(scene.objects[robot.links[link].object]);
      if (std::isfinite(radius)) {
        ball.radius = std::max(ball.radius, radius);
        continue;
      }
      if (robot.is_attached) continue;  // to an object that moves: no robot carries it
      return fmt::format(
          "'{}' of robot '{}' can go anywhere: its base moves without that of another robot, or "
          "a joint slides without limits",
          robot.links[link].name, robot.name);
    }
  }
  if (first == nullptr) return "the cell has no robot";
  ball.radius *= 1.0 + 0x1p-40;
  return ball;
}

}  // namespace clearance
