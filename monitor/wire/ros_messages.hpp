// The daemon's topics as messages of clearance_msgs. idl/ros_messages.py makes the types from
// clearance.idl with the same fields, so that a sample of the daemon is a message as it stands.
#pragma once

#include <array>
#include <string_view>

#include "clearance_msgs.h"
#include "clearance_msgs_hashes.hpp"
#include "monitor/wire/ros_types.hpp"
#include "monitor/wire/topics.hpp"

namespace clearance {

template <>
[[nodiscard]] inline const dds_topic_descriptor_t&
topic_descriptor<clearance_msgs_msg_dds__ZoneStates_>() noexcept {
  return clearance_msgs_msg_dds__ZoneStates__desc;
}

// One row a message: the topic of the daemon and its type in ROS 2. States are latched; what is
// written every tick is not.
struct RosMessage {
  TopicKind kind;
  RosType type;
};
inline constexpr std::array kRosMessageTypes = {
    RosMessage{TopicKind::kCatalogue,
               {&clearance_msgs_msg_dds__Catalogue__desc, ros_hashes::kCatalogue, true, 1}},
    RosMessage{TopicKind::kDistances,
               {&clearance_msgs_msg_dds__Distances__desc, ros_hashes::kDistances, false, 64, 10}},
    RosMessage{TopicKind::kZones,
               {&clearance_msgs_msg_dds__ZoneStates__desc, ros_hashes::kZoneStates, true, 1}},
    RosMessage{TopicKind::kHealth,
               {&clearance_msgs_msg_dds__Health__desc, ros_hashes::kHealth, true, 1}},
    RosMessage{TopicKind::kSeparation,
               {&clearance_msgs_msg_dds__Separation__desc, ros_hashes::kSeparation, false, 64, 10}},
    RosMessage{TopicKind::kGradients,
               {&clearance_msgs_msg_dds__Gradients__desc, ros_hashes::kGradients, false, 64, 10}},
};

}  // namespace clearance
