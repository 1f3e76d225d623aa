// MoveIt's messages from the wire.
#pragma once

#include "config/moveit/message.hpp"
#include "monitor/wire/moveit_types.hpp"

namespace clearance::moveit {

[[nodiscard]] CollisionObject from_wire(const moveit_msgs_msg_dds__CollisionObject_& message);
[[nodiscard]] AttachedCollisionObject from_wire(
    const moveit_msgs_msg_dds__AttachedCollisionObject_& message);
[[nodiscard]] PlanningScene from_wire(const moveit_msgs_msg_dds__PlanningScene_& message);

}  // namespace clearance::moveit
