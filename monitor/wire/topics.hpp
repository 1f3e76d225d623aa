// The topics of Clearance in one table: cell key, name, type, quality of service, history
// depths.
//
// DDS endpoints, recordings and tools take everything about a topic from here. idl/README.md says
// why each topic has its QoS. A test compares the table there with this one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

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
  kCommands,
  kCommandResults,
  kQuestions,
  kAnswers,
  kPartnerTicks,
  kPartnerStates,
  kPartnerFrames,
  kPartnerScenes,
};

// The delivery of a topic. Both are reliable with keep-last history.
enum class Delivery : std::uint8_t {
  kStream,   // volatile: a reader gets what is sent from now on
  kLatched,  // transient-local: a late reader gets the last sample of each key
};

// One row of the table.
struct Topic {
  TopicKind kind;
  std::string_view key;       // in a cell and in command lines
  std::string Topics::*name;  // in a scene; Topics has the defaults
  const dds_topic_descriptor_t* type;
  Delivery delivery;
  std::int32_t writer_depth;  // samples of a key that a writer keeps for its readers
  std::int32_t reader_depth;  // samples of a key that may wait, unless a reader asks for more
};

// In the order of TopicKind and of kTopicKeys, which is that of recordings: inputs stand before the
// reports that used them. A distances writer keeps 64 reports for a client that is held up for a
// moment. Inputs are states, of which only the newest counts: behind a lost sample, a reader waits
// for as many samples as the writer keeps. What waits in a reader is taken at once and delays
// nothing, so a reader may be late by 16 batches (16 ms at 1 kHz) without losing any. Commands
// and questions are repeated by their client until a result comes, so a lost one does no harm.
inline constexpr auto kTopics = [] {
  constexpr auto row = [](TopicKind kind, const dds_topic_descriptor_t& type, Delivery delivery,
                          std::int32_t writer_depth, std::int32_t reader_depth) {
    const TopicKey& key = kTopicKeys[static_cast<std::size_t>(kind)];
    return Topic{kind, key.key, key.name, &type, delivery, writer_depth, reader_depth};
  };
  using enum TopicKind;
  using enum Delivery;
  return std::array{
      row(kCatalogue, clearance_msg_Catalogue_desc, kLatched, 1, 1),
      row(kPoses, clearance_msg_PoseBatch_desc, kStream, 4, 16),
      row(kJointStates, clearance_msg_JointStates_desc, kStream, 4, 16),
      row(kDistances, clearance_msg_Distances_desc, kStream, 64, 64),
      row(kZones, clearance_msg_ZoneState_desc, kLatched, 1, 1),
      row(kHealth, clearance_msg_Health_desc, kLatched, 1, 1),
      row(kSeparation, clearance_msg_Separation_desc, kStream, 64, 64),
      row(kGradients, clearance_msg_Gradients_desc, kStream, 64, 64),
      row(kCommands, clearance_msg_Command_desc, kStream, 64, 64),
      row(kCommandResults, clearance_msg_CommandResult_desc, kLatched, 64, 64),
      row(kQuestions, clearance_msg_Question_desc, kStream, 64, 64),
      row(kAnswers, clearance_msg_Answer_desc, kStream, 64, 64),
      row(kPartnerTicks, clearance_msg_PartnerTick_desc, kStream, 64, 256),
      row(kPartnerStates, clearance_msg_PartnerState_desc, kStream, 1, 4),
      row(kPartnerFrames, clearance_msg_PartnerFrame_desc, kLatched, 1, 1),
      row(kPartnerScenes, clearance_msg_PartnerScene_desc, kLatched, 1, 1),
  };
}();
static_assert(kTopics.size() == kTopicKeys.size());

// The topics that recordings and viewers have. A command is what a client asked for, and the
// catalogue has what came of it. A question changes nothing.
inline constexpr std::span<const Topic> kRecordedTopics =
    std::span(kTopics).first(static_cast<std::size_t>(TopicKind::kCommands));

[[nodiscard]] constexpr std::size_t index(TopicKind kind) noexcept {
  return static_cast<std::size_t>(kind);
}
[[nodiscard]] constexpr const Topic& topic(TopicKind kind) noexcept { return kTopics[index(kind)]; }

}  // namespace clearance
