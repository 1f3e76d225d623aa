// A decoder turns the messages of one kind of topic into batches of the tick's inputs.
//
// A new kind of input needs a decoder, a row in intake.cpp, and a test: see README.md.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/intake/news.hpp"
#include "monitor/intake/raw_message.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance {

// Counts of a topic's messages.
struct TopicCounts {
  std::uint64_t messages = 0;
  std::uint64_t undecodable = 0;
  std::uint64_t unstamped = 0;           // messages whose stamp is 0
  std::uint64_t of_another_clock = 0;    // their stamp is far from their time of sending
  std::int64_t clock_difference_ns = 0;  // of the first such message
};

// The receiver of a decoder's batches and news.
class Outlet {
 public:
  virtual ~Outlet() = default;
  // Receives a batch and may exchange its memory. `writer` is the writer of the batch. `cut` counts
  // the samples that were left out because the length of a batch is limited.
  virtual void give(PoseBatch& batch, std::uint64_t writer, std::size_t cut) = 0;
  virtual void tell(News news) = 0;
};

// A topic of ROS 2 that a cell names, in ROS 2's spelling, and its only type.
struct NamedTopic {
  std::string name;
  const RosType* delivery = nullptr;
};

// To be used by one thread.
class Decoder {
 public:
  // The answer for a topic that the decoder takes: its own number for the topic, and the delivery
  // of the ROS 2 type. A null delivery means a topic of ours, delivered as the table of topics
  // says.
  struct Wanted {
    std::uint32_t port = 0;
    const RosType* delivery = nullptr;
  };

  virtual ~Decoder() = default;
  // Returns nothing if the decoder does not take the topic. The same topic gets the same answer.
  [[nodiscard]] virtual std::optional<Wanted> wants(const TopicName& topic) = 0;
  // The topics that the decoder would take, as far as the cell names them.
  [[nodiscard]] virtual std::vector<NamedTopic> named() const { return {}; }
  // Returns false if the bytes are not a message of the topic's type.
  [[nodiscard]] virtual bool decode(std::uint32_t port, const RawMessage& message, const Now& now,
                                    TopicCounts& counts) = 0;
  // The cell has changed, except for the names of its topics. What other programs said stays known.
  // The new cell must outlive this.
  virtual void change(const Cell&) {}
  // Called after all available messages, and at the latest after patience_ns().
  virtual void settle(const Now&) {}
  [[nodiscard]] virtual std::int64_t patience_ns() const {
    return std::numeric_limits<std::int64_t>::max();
  }
  // Tells the decoder which writers still exist; sorted.
  virtual void keep(std::span<const std::uint64_t>) {}
};

}  // namespace clearance
