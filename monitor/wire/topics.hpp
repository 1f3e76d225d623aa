// The topics of Clearance in one table: cell key, name, type, quality of service, history
// depths.
//
// DDS endpoints, recordings and tools take everything about a topic from here; a test holds the
// table of idl/README.md against it, which says why each topic has its QoS.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "config/cell/topics.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

enum class TopicKind : std::uint8_t {
  kCatalogue,
  kPoses,
  kJointStates,
  kDistances,
  kZones,
  kHealth,
  kSeparation,
  kGradients,
};

// How a topic is delivered. Both are reliable with keep-last history.
enum class Delivery : std::uint8_t {
  kStream,   // volatile: a reader gets what is sent from now on
  kLatched,  // transient-local, depth 1: a late reader gets the last sample of each key
};

// One row of the table.
struct Topic {
  TopicKind kind;
  std::string Topics::*name;  // in a scene; Topics has the defaults
  const dds_topic_descriptor_t* type;
  Delivery delivery;
  std::int32_t writer_depth;  // samples of a key that a writer keeps for its readers
  std::int32_t reader_depth;  // samples of a key that may wait, unless a reader asks for more
};

// In the order of TopicKind, which is that of recordings: what comes in stands before the reports
// that used them. A distances writer keeps 64 reports for a client that is held up for a moment;
// the daemon may be 16 batches of a source (16 ms at 1 kHz) late in taking poses without losing
// any.
inline constexpr std::array<Topic, 8> kTopics = {{
    {TopicKind::kCatalogue, &Topics::catalogue, &clearance_msg_Catalogue_desc, Delivery::kLatched,
     1, 1},
    {TopicKind::kPoses, &Topics::poses, &clearance_msg_PoseBatch_desc, Delivery::kStream, 64, 16},
    {TopicKind::kJointStates, &Topics::joint_states, &clearance_msg_JointStates_desc,
     Delivery::kStream, 64, 16},
    {TopicKind::kDistances, &Topics::distances, &clearance_msg_Distances_desc, Delivery::kStream,
     64, 64},
    {TopicKind::kZones, &Topics::zones, &clearance_msg_ZoneState_desc, Delivery::kLatched, 1, 1},
    {TopicKind::kHealth, &Topics::health, &clearance_msg_Health_desc, Delivery::kLatched, 1, 1},
    {TopicKind::kSeparation, &Topics::separation, &clearance_msg_Separation_desc, Delivery::kStream,
     64, 64},
    {TopicKind::kGradients, &Topics::gradients, &clearance_msg_Gradients_desc, Delivery::kStream,
     64, 64},
}};

[[nodiscard]] constexpr std::size_t index(TopicKind kind) noexcept {
  return static_cast<std::size_t>(kind);
}
[[nodiscard]] constexpr const Topic& topic(TopicKind kind) noexcept { return kTopics[index(kind)]; }

}  // namespace clearance
