// The body that a link or an object is rigidly connected to.
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
  friend bool operator==(const RigidRoot&, const RigidRoot&) = default;
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

}  // namespace clearance
