// At most one gap exists at a time, since the ring is shorter than two rounds.
#include "monitor/recording/event_ring.hpp"

#include <algorithm>

namespace clearance {
namespace {

constexpr std::size_t kFewest = 4096;
constexpr std::size_t kAlign = 8;

constexpr std::uint64_t aligned(std::uint64_t bytes) {
  return (bytes + kAlign - 1) / kAlign * kAlign;
}

}  // namespace

EventRing::EventRing(std::size_t bytes) : memory_(aligned(std::max(bytes, kFewest))) {}

EventRing::Found EventRing::at(std::uint64_t place) const {
  const std::byte* const begin = memory_.data() + place % memory_.size();
  Header header{};
  std::memcpy(&header, begin, sizeof header);
  std::uint64_t next = place + aligned(sizeof header + header.bytes);
  if (next == left_) next += to_the_end(next);
  return {{.kind = header.kind,
           .side = header.side,
           .is_start = header.is_start,
           .repeated = header.repeated,
           .scene = header.scene,
           .log_ns = header.log_ns,
           .publish_ns = header.publish_ns,
           .cdr = {begin + sizeof header, header.bytes}},
          next};
}

// A group is a start and what follows up to the next start.
void EventRing::drop_front() {
  do {
    tail_ = at(tail_).next;
  } while (!empty() && !at(tail_).message.is_start);
}

void EventRing::put(const RingMessage& message) {
  if (waits_for_start_ && !message.is_start) return;
  waits_for_start_ = false;
  const Header header{message.log_ns, message.publish_ns, message.cdr.size(), message.scene,
                      message.kind,   message.side,       message.is_start,   message.repeated};
  const std::uint64_t need = aligned(sizeof header + message.cdr.size());
  const std::uint64_t gap = to_the_end(head_) < need ? to_the_end(head_) : 0;
  while (!empty() && head_ + gap + need - tail_ > memory_.size()) drop_front();
  if (need > memory_.size() || (empty() && !message.is_start)) {
    tail_ = head_;
    waits_for_start_ = true;
    return;
  }
  if (gap > 0) {
    left_ = head_;
    if (empty()) tail_ = head_ + gap;
    head_ += gap;
  }
  std::byte* const begin = memory_.data() + head_ % memory_.size();
  std::memcpy(begin, &header, sizeof header);
  if (!message.cdr.empty())
    std::memcpy(begin + sizeof header, message.cdr.data(), message.cdr.size());
  head_ += need;
}

void EventRing::drop_before(std::int64_t log_ns) {
  std::uint64_t begin = tail_;
  for (std::uint64_t place = tail_; place != head_;) {
    const Found found = at(place);
    if (found.message.log_ns > log_ns) break;
    if (found.message.is_start) begin = place;
    place = found.next;
  }
  tail_ = begin;
}

}  // namespace clearance
