// The messages of one topic that a daemon writes every tick beside its report.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <utility>

#include "monitor/wire/cdr.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// Keeps them in file order. A tick's time is its own, so that it tells which tick they belong to.
template <class Message>
class TickMessages {
 public:
  explicit TickMessages(bool wanted) : wanted_(wanted) {}

  void add(std::span<const std::byte> cdr, CdrDecoder& decoder) {
    if (!wanted_) ++unwanted_;
    Sample<Message> message;
    if (!wanted_ || !decoder.decode(cdr, message)) return;
    waiting_.push_back(std::move(message));
    expected_ = true;
  }
  // The message of the tick at `now_ns`; null: there is none. In a recording over DDS it may stand
  // behind the report: `read_ahead` reads one message more and returns false at the limit. After
  // one search in vain nothing is read ahead until a message comes, since most recordings have all
  // or none.
  template <class ReadAhead>
  [[nodiscard]] const Message* of_tick(std::int64_t now_ns, const ReadAhead& read_ahead) {
    if (!wanted_) return nullptr;
    const auto has_reached = [&] {
      for (; !waiting_.empty() && waiting_.front()->now_ns < now_ns; waiting_.pop_front())
        unmatched_ += matched_ns_ && waiting_.front()->now_ns != *matched_ns_;
      return !waiting_.empty();
    };
    while (!has_reached() && expected_) {
      if (!read_ahead()) expected_ = false;
    }
    const bool found = has_reached() && waiting_.front()->now_ns == now_ns;
    matched_ns_ = now_ns;
    return found ? &*waiting_.front() : nullptr;
  }

  // The number of messages that came although none is wanted.
  [[nodiscard]] std::uint64_t unwanted() const noexcept { return unwanted_; }
  // The number of messages that belong to no report. Those from before the first report do not
  // count.
  [[nodiscard]] std::uint64_t unmatched() const noexcept { return unmatched_; }

 private:
  bool wanted_;
  bool expected_ = true;
  std::uint64_t unwanted_ = 0, unmatched_ = 0;
  std::optional<std::int64_t> matched_ns_;  // of the last tick that was asked for
  std::deque<Sample<Message>> waiting_;
};

}  // namespace clearance
