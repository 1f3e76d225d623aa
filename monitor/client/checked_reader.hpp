// Reads a topic that the daemon does not write in each tick: catalogue, zones, health, results.
// A message that is not as its daemon wrote it is counted and not handed out (END_TO_END.md).
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <string>
#include <vector>

#include "monitor/wire/report_check.hpp"

namespace clearance {

class Participant;
enum class TopicKind : std::uint8_t;

namespace client {

// The messages that came and were not handed out.
struct RefusedMessages {
  std::uint64_t count = 0;
  ReportError last = ReportError::kGood;  // why: kCorrupt or kOtherAddress
  std::string topic;
};

class CheckedReader {
 public:
  // The participant owns the DDS reader. With `of_several`, it keeps the values of several daemons.
  CheckedReader(Participant& participant, TopicKind kind, const std::string& topic,
                bool of_several = false);

  // Takes the next message that is good. False when none waits; `message` may be changed, though.
  // With `keys_too`, also one that only tells that an instance is gone: `message` has its key then,
  // and `info` no valid data.
  template <class Message>
  bool take(Message& message, dds_sample_info_t& info, bool keys_too = false);
  template <class Message>
  bool take(Message& message) {
    dds_sample_info_t info;
    return take(message, info);
  }

  [[nodiscard]] dds_entity_t entity() const noexcept { return entity_; }
  [[nodiscard]] const RefusedMessages& refused() const noexcept { return refused_; }

 private:
  dds_entity_t entity_;
  std::uint64_t address_;
  RefusedMessages refused_;
};

// Returns "3 messages of clearance/zones were refused, the last one as corrupt; ...", or nothing.
[[nodiscard]] std::string text_of(const std::vector<RefusedMessages>& topics);

}  // namespace client
}  // namespace clearance
