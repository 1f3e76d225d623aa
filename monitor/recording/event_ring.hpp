// The messages of the last ticks in a fixed piece of memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include "monitor/recording/topic_schema.hpp"
#include "monitor/wire/topics.hpp"

namespace clearance {

struct RingMessage {
  TopicKind kind = TopicKind::kPoses;
  std::optional<SideTopic> side = {};  // then it is of no kind
  bool is_start = false;               // a file may begin here
  bool repeated = false;               // a file needs this message only in its first tick
  std::uint32_t scene = 0;
  std::int64_t log_ns = 0, publish_ns = 0;
  std::span<const std::byte> cdr;
};

// The oldest messages go when there is no space, always up to the next start. Takes its memory
// once.
class EventRing {
 public:
  // At least 4096 bytes are taken.
  explicit EventRing(std::size_t bytes);

  // A message that does not fit into the ring empties it up to the next start.
  void put(const RingMessage& message);

  [[nodiscard]] bool empty() const noexcept { return tail_ == head_; }
  // The first message; the ring must not be empty.
  [[nodiscard]] RingMessage front() const { return at(tail_).message; }
  void clear() noexcept { tail_ = head_; }
  // Drops what is before the last start at or before this time.
  void drop_before(std::int64_t log_ns);

  // Calls `use` with every message in order.
  template <class Use>
  void for_each(const Use& use) const {
    for (std::uint64_t place = tail_; place != head_;) {
      const Found found = at(place);
      use(found.message);
      place = found.next;
    }
  }

 private:
  struct Header {
    std::int64_t log_ns, publish_ns;
    std::uint64_t bytes;
    std::uint32_t scene;
    TopicKind kind;
    std::optional<SideTopic> side;
    bool is_start, repeated;
  };
  struct Found {
    RingMessage message;
    std::uint64_t next;
  };

  [[nodiscard]] Found at(std::uint64_t place) const;
  void drop_front();
  [[nodiscard]] std::uint64_t to_the_end(std::uint64_t place) const noexcept {
    return memory_.size() - place % memory_.size();
  }

  std::vector<std::byte> memory_;
  // Places count all bytes so far. Their remainder by the size of the memory is the offset.
  std::uint64_t tail_ = 0, head_ = 0;
  // A message stands in one piece. Where the end of the memory is too small for it, the next one
  // begins at offset 0, and this is the place that was left.
  std::uint64_t left_ = ~std::uint64_t{0};
  bool waits_for_start_ = true;
};

}  // namespace clearance
