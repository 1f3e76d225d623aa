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

}  // namespace

std::variant<ReachBall, std::string> robots_reach(const Scene& scene) {
  // By robot and link: the distance from the centre, which is the first robot's base.
  std::vector<std::vector<double>> reach(scene.robots.size());
  ReachBall ball;
  bool has_centre = false;
  for (std::size_t i = 0; i < scene.robots.size(); ++i) {
    const Robot& robot = scene.robots[i];
    const RobotBase& base = robot.base;
    const double arm = base.base_from_root.position.norm();
    double root = kInfinity;
    if (base.kind == RobotBase::Kind::kLink) {
      root = reach[base.robot][base.link] + arm;
    } else if (base.kind == RobotBase::Kind::kWorld && base.frame.empty()) {
      if (!has_centre) ball.centre = base.base_from_root.position;
      has_centre = true;
      root = (base.base_from_root.position - ball.centre).norm();
    }
    reach[i].assign(robot.links.size(), kInfinity);
    reach[i][0] = root;
    for (std::size_t joint = 0; joint < robot.joints.size(); ++joint) {
      const RobotJoint& of = robot.joints[joint];
      reach[i][joint + 1] =
          reach[i][of.parent] + of.parent_from_joint.position.norm() + travel(of, scene.variables);
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
          "'{}' of robot '{}' can go anywhere: its base moves, or a joint slides "
          "without limits",
          robot.links[link].name, robot.name);
    }
  }
  if (!has_centre) return "the cell has no robot whose base stands still";
  ball.radius *= 1.0 + 0x1p-40;
  return ball;
}

}  // namespace clearance
