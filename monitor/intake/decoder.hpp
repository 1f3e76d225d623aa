// What makes batches of the tick's inputs out of the messages of one kind of topic.
//
// A new kind of input is a decoder, a row in intake.cpp, and a test: README.md says how.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "monitor/inputs/pose_batch.hpp"
#include "monitor/intake/news.hpp"
#include "monitor/intake/raw_message.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance {

// Counts of a topic's messages.
struct TopicCounts {
  std::uint64_t messages = 0;
  std::uint64_t undecodable = 0;
  std::uint64_t unstamped = 0;           // their stamp is 0
  std::uint64_t of_another_clock = 0;    // their stamp is far from when they were sent
  std::int64_t clock_difference_ns = 0;  // of the first such stamp
};

// Where a decoder leaves what it has made.
class Outlet {
 public:
  virtual ~Outlet() = default;
  // A batch, which may be exchanged for another one's memory; `writer`: whose it is; `cut`: samples
  // that were left out since the batch may not be longer.
  virtual void give(PoseBatch& batch, std::uint64_t writer, std::size_t cut) = 0;
  virtual void tell(News news) = 0;
};

// For one thread.
class Decoder {
 public:
  // A topic that is wanted: the decoder's own number for it, and how ROS 2 delivers it; null: a
  // topic of ours, delivered as the table of topics says.
  struct Wanted {
    std::uint32_t port = 0;
    const RosType* delivery = nullptr;
  };

  virtual ~Decoder() = default;
  // Nothing: not a topic for this decoder. The same topic gets the same answer.
  [[nodiscard]] virtual std::optional<Wanted> wants(const TopicName& topic) = 0;
  // False: the bytes are no message of the topic's type.
  [[nodiscard]] virtual bool decode(std::uint32_t port, const RawMessage& message, const Now& now,
                                    TopicCounts& counts) = 0;
  // After all messages that had come, and at the latest after patience_ns().
  virtual void settle(const Now&) {}
  [[nodiscard]] virtual std::int64_t patience_ns() const {
    return std::numeric_limits<std::int64_t>::max();
  }
  // Only these writers are still there; sorted.
  virtual void keep(std::span<const std::uint64_t>) {}
};

}  // namespace clearance
