// The types of MoveIt that we read and write, as wire/ros_types.hpp has those of ROS 2.
#pragma once

#include "monitor/wire/ros_types.hpp"
#include "moveit.h"

namespace clearance {

template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<moveit_msgs_msg_dds__CollisionObject_>() noexcept {
  return moveit_msgs_msg_dds__CollisionObject__desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<moveit_msgs_msg_dds__AttachedCollisionObject_>() noexcept {
  return moveit_msgs_msg_dds__AttachedCollisionObject__desc;
}
template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<moveit_msgs_msg_dds__PlanningScene_>() noexcept {
  return moveit_msgs_msg_dds__PlanningScene__desc;
}

template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<octomap_msgs_msg_dds__Octomap_>() noexcept {
  return octomap_msgs_msg_dds__Octomap__desc;
}

template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<trajectory_msgs_msg_dds__JointTrajectory_>() noexcept {
  return trajectory_msgs_msg_dds__JointTrajectory__desc;
}

// A message that is lost is a change that is lost, so readers are reliable. MoveIt's writers are,
// too, and volatile.
inline constexpr RosType kRosCollisionObject{
    &moveit_msgs_msg_dds__CollisionObject__desc,
    "typehash=RIHS01_74b0acd6d56be032bf4f764b2c2633f50588b5fb2bd71e97206c59052747cf7e;",
    false,
    256,
    16,
    true};
inline constexpr RosType kRosAttachedCollisionObject{
    &moveit_msgs_msg_dds__AttachedCollisionObject__desc,
    "typehash=RIHS01_7fdfe7951a33a857f20fc42c9ed410a38d06dd0c209ac774ecea746dc487dc41;",
    false,
    256,
    16,
    true};
inline constexpr RosType kRosPlanningScene{
    &moveit_msgs_msg_dds__PlanningScene__desc,
    "typehash=RIHS01_0f58540ad5eab4b9ea827d53b763c793d8cabd202b3b301fcee25afa4ce1bd80;",
    false,
    256,
    16,
    true};

// Maps are large and come seldom. Servers of maps publish them reliably, and most keep the last one
// for late readers.
inline constexpr RosType kRosOctomap{
    &octomap_msgs_msg_dds__Octomap__desc,
    "typehash=RIHS01_9891a19a05b70ec20aa8f45db3f8300b9ab80afff32c61c549d25087da9625b0;",
    false,
    2,
    2,
    false,
    true};

// A motion that a controller gets: each one counts.
inline constexpr RosType kRosJointTrajectory{
    &trajectory_msgs_msg_dds__JointTrajectory__desc,
    "typehash=RIHS01_179b33eba59d676f6d967ac71fe35e7ca2f64b2f3928f4a018cec115e213796e;",
    false,
    64,
    16,
    true};

// The scene that a daemon publishes: a late reader gets the present one.
inline constexpr RosType kRosMonitoredScene{kRosPlanningScene.descriptor,
                                            kRosPlanningScene.user_data, true, 1};

}  // namespace clearance
