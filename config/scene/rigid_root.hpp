// The body that a link or an object is rigidly connected to, and what an attached object hangs on.
#pragma once

#include <cstdint>
#include <span>

#include "config/scene/robot.hpp"

namespace clearance {

// An object whose pose arrives, or the first link behind a moving joint.
struct RigidRoot {
  bool is_object = true;
  std::uint32_t index = 0;  // of the object, or of the robot
  std::uint32_t link = 0;
  friend auto operator<=>(const RigidRoot&, const RigidRoot&) = default;
};

[[nodiscard]] inline RigidRoot root_of_link(std::span<const Robot> robots, std::uint32_t robot,
                                            std::uint32_t link) {
  for (;;) {
    const Robot& of = robots[robot];
    while (link > 0) {
      const RobotJoint& joint = of.joints[link - 1];
      if (joint.type != JointType::kFixed) return {false, robot, link};
      link = joint.parent;
    }
    if (of.base.kind == RobotBase::Kind::kObject) return {true, of.base.object, 0};
    if (of.base.kind == RobotBase::Kind::kWorld) return {false, robot, 0};
    link = of.base.link;
    robot = of.base.robot;
  }
}

// The last of the chain from a robot over the attached objects below it: a robot that is not
// attached, or an attached object that is on no link.
[[nodiscard]] inline const Robot& carrier_of(std::span<const Robot> robots, const Robot& robot) {
  const Robot* at = &robot;
  while (at->is_attached && at->base.kind == RobotBase::Kind::kLink) at = &robots[at->base.robot];
  return *at;
}

// Tells whether it is a robot, or an attached object that a robot carries.
[[nodiscard]] inline bool is_of_a_robot(std::span<const Robot> robots, const Robot& robot) {
  return !carrier_of(robots, robot).is_attached;
}

}  // namespace clearance
