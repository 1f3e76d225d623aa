// A message of any topic before decoding, from DDS or from a log.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "monitor/wire/cdr.hpp"

namespace clearance {

// The name and type of a topic in ROS 2's spelling, or as the cell names a topic of ours.
struct TopicName {
  std::string name;  // e.g. /joint_states
  std::string type;  // e.g. sensor_msgs/msg/JointState
};

// Converts DDS names to ROS 2's: rt/tf of tf2_msgs::msg::dds_::TFMessage_ is /tf of
// tf2_msgs/msg/TFMessage. Other names stay as they are.
[[nodiscard]] TopicName as_in_ros(std::string_view dds_name, std::string_view dds_type);

struct RawMessage {
  std::uint32_t topic = 0;         // the number from Intake::topic()
  std::span<const std::byte> cdr;  // with the encapsulation header; valid during the call
  // The sender's CLOCK_REALTIME at sending; in a log, the time of recording.
  std::int64_t sent_ns = 0;
  std::uint64_t writer = 0;  // a unique number for each sender; 0 in a log
  CdrBytes bytes = CdrBytes::kUnchecked;
};

// The current time. In a log, both members are the time of recording.
struct Now {
  std::int64_t realtime_ns = 0, monotonic_ns = 0;
};

}  // namespace clearance
