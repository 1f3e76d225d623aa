// Limits the log lines about one kind of refusal, since refusals may come at any rate.
#pragma once

#include <cstdint>
#include <utility>

#include "config/text/sentences.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/interface/mutex.hpp"

namespace clearance {

// Any thread but that of the tick.
class LineLimit {
 public:
  static constexpr std::uint64_t kLinesASecond = 5;

  // `left_out` is the log line that states how many lines were left out.
  explicit LineLimit(const LogLine<lines::Text>& left_out) : line_(left_out) {}

  // Returns whether one more line may be logged; `now_ns` is CLOCK_MONOTONIC. The first call in a
  // new second logs how many lines were left out before.
  [[nodiscard]] bool admits(std::int64_t now_ns) {
    const Lock lock(mutex_);
    const std::int64_t second = now_ns / 1'000'000'000;
    if (std::exchange(second_, second) != second) {
      if (left_out_ > 0) log_line(line_, counted(left_out_, "line"));
      logged_ = left_out_ = 0;
    }
    if (++logged_ <= kLinesASecond) return true;
    ++left_out_;
    return false;
  }

 private:
  const LogLine<lines::Text>& line_;
  Mutex mutex_;
  GUARDED_BY(mutex_) std::int64_t second_ = -1;
  GUARDED_BY(mutex_) std::uint64_t logged_ = 0, left_out_ = 0;  // in that second
};

}  // namespace clearance
