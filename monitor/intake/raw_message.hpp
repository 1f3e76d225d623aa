// A message of any topic as it came: over DDS, or out of a log.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "monitor/wire/cdr.hpp"

namespace clearance {

// As ROS 2 names both, or as the cell names a topic of ours.
struct TopicName {
  std::string name;  // e.g. /joint_states
  std::string type;  // e.g. sensor_msgs/msg/JointState
};

// DDS's rt/tf of tf2_msgs::msg::dds_::TFMessage_ is /tf of tf2_msgs/msg/TFMessage. Names that are
// not of ROS 2 stay as they are.
[[nodiscard]] TopicName as_in_ros(std::string_view dds_name, std::string_view dds_type);

struct RawMessage {
  std::uint32_t topic = 0;         // as Intake::topic() numbers them
  std::span<const std::byte> cdr;  // with the encapsulation header; valid during the call
  // CLOCK_REALTIME of who sent it; out of a log, when it was recorded.
  std::int64_t sent_ns = 0;
  std::uint64_t writer = 0;  // who sent it, any number of its own; out of a log 0
  CdrBytes bytes = CdrBytes::kUnchecked;
};

// The time at which something is looked at. Out of a log, both are the time of recording.
struct Now {
  std::int64_t realtime_ns = 0, monotonic_ns = 0;
};

}  // namespace clearance
