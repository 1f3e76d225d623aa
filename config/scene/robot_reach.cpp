#include "config/scene/robot_reach.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
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

bool follows_a_frame(const Robot& robot) { return !robot.base.frame.empty(); }

// The ball without its radius: around the base of this robot.
ReachBall ball_around(const Robot& robot, std::uint32_t index) {
  ReachBall ball;
  ball.is_carried = robot.base.kind != RobotBase::Kind::kWorld || follows_a_frame(robot);
  ball.centre = robot.base.base_from_root.position;
  ball.robot = index;
  ball.link = follows_a_frame(robot) ? 1 : 0;
  return ball;
}

// The distances of a robot's links from the centre of their ball, m.
std::vector<double> distances(const Robot& robot, double root,
                              const std::vector<JointVariable>& variables) {
  std::vector<double> out(robot.links.size(), root);
  for (std::size_t joint = 0; joint < robot.joints.size(); ++joint) {
    const RobotJoint& of = robot.joints[joint];
    if (joint == 0 && follows_a_frame(robot)) continue;  // it leads to the base
    out[joint + 1] = out[of.parent] + of.parent_from_joint.position.norm() + travel(of, variables);
  }
  return out;
}

}  // namespace

double radius_of(const Object& object) {
  double radius = 0.0;
  for (const Part& part : object.parts) {
    if (!part.shape.bounded()) return kInfinity;
    radius = std::max(radius, part.object_from_part.position.norm() + part.shape.bounding_radius +
                                  part.shape.radius + part.shape.position_error);
  }
  return radius;
}

// Robots on a link are in the ball of the robot that carries them. What is attached to a moving
// object has no ball, since no robot carries it.
std::variant<std::vector<ReachBall>, std::string> robots_reach(const Scene& scene) {
  constexpr std::size_t kNoBall = std::numeric_limits<std::size_t>::max();
  std::vector<ReachBall> balls;
  std::vector<std::vector<double>> reach;  // by robot and link: from the centre of its ball
  std::vector<std::size_t> ball_of;        // by robot
  for (std::size_t i = 0; i < scene.robots.size(); ++i) {
    const Robot& robot = scene.robots[i];
    const RobotBase& base = robot.base;
    double root = 0.0;
    if (base.kind == RobotBase::Kind::kLink && ball_of[base.robot] != kNoBall) {
      root = reach[base.robot][base.link] + base.base_from_root.position.norm();
      ball_of.push_back(ball_of[base.robot]);
    } else if (robot.is_attached) {
      ball_of.push_back(kNoBall);
    } else {
      ball_of.push_back(balls.size());
      balls.push_back(ball_around(robot, static_cast<std::uint32_t>(i)));
    }
    reach.push_back(distances(robot, root, scene.variables));
    if (ball_of[i] == kNoBall) continue;
    for (std::size_t link = 0; link < robot.links.size(); ++link) {
      if (robot.links[link].object == RobotLink::kNoObject) continue;
      const double radius = reach[i][link] + radius_of(scene.objects[robot.links[link].object]);
      if (!std::isfinite(radius)) {
        return fmt::format("'{}' of robot '{}' can go anywhere: a joint slides without limits",
                           robot.links[link].name, robot.name);
      }
      balls[ball_of[i]].radius = std::max(balls[ball_of[i]].radius, radius * (1.0 + 0x1p-40));
    }
  }
  if (balls.empty()) return "the cell has no robot";
  return balls;
}

}  // namespace clearance
