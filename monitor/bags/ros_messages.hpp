// The messages of ROS 2 that say where a robot is, decoded from CDR of any origin.
//
// Layouts as in sensor_msgs, tf2_msgs, geometry_msgs and std_msgs, unchanged from Humble to
// Rolling.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/pose.hpp"

namespace clearance {

// sensor_msgs/msg/JointState. Sequences may be shorter than `name`, or empty.
struct RosJointState {
  std::int64_t stamp_ns = 0;  // 0: the publisher states none
  std::string frame;
  std::vector<std::string> name;
  std::vector<double> position, velocity, effort;
};

// geometry_msgs/msg/TransformStamped.
struct RosTransform {
  std::int64_t stamp_ns = 0;
  std::string parent, child;  // frame_id, child_frame_id
  Pose parent_from_child;     // unchecked: its quaternion may be anything
};

inline constexpr const char* kRosJointState = "sensor_msgs/msg/JointState";
inline constexpr const char* kRosTransforms = "tf2_msgs/msg/TFMessage";
inline constexpr const char* kRosString = "std_msgs/msg/String";

// Each takes CDR with its encapsulation header (XCDR1, either byte order). Nothing: the bytes are
// no such message.
[[nodiscard]] std::optional<RosJointState> ros_joint_state(std::span<const std::byte> cdr);
[[nodiscard]] std::optional<std::vector<RosTransform>> ros_transforms(
    std::span<const std::byte> cdr);
[[nodiscard]] std::optional<std::string> ros_string(std::span<const std::byte> cdr);

}  // namespace clearance
