// The channels of clearance-view: the messages of DDS, byte for byte, and the scene for viewers of
// ROS 2 messages. An id stays the same while the program runs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "monitor/files/format.hpp"
#include "monitor/wire/topics.hpp"

namespace clearance::view {

using ChannelId = std::uint32_t;

// Our topics have the ids of their TopicKind; these ids follow.
inline constexpr ChannelId kTransforms = kRecordedTopics.size(), kBodies = kTransforms + 1,
                           kClosest = kTransforms + 2, kSeen = kTransforms + 3,
                           kChannels = kTransforms + 4;
[[nodiscard]] constexpr ChannelId channel(TopicKind kind) noexcept {
  return static_cast<ChannelId>(index(kind));
}

struct Channel {
  std::string topic;
  McapSchema schema;  // messages are CDR
};

// By id, under the cell's names of the topics.
[[nodiscard]] std::vector<Channel> channels_of(const Topics& topics);

}  // namespace clearance::view
