// The longest that reports took lately, from the time that their tick was told until they were
// handed to DDS. The loop tells its ticks (TickTime::report_delay_ns).
#pragma once

#include <algorithm>
#include <cstdint>

#include "monitor/inputs/tick_time.hpp"

namespace clearance {

// "Lately" is the last kWindowNs to 2 * kWindowNs: the present window and the one before.
class ReportDelay {
 public:
  static constexpr std::int64_t kWindowNs = 5'000'000'000;

  // Before each tick, CLOCK_MONOTONIC. The longest delay that has been measured since the last
  // call; kNotMeasured: none was.
  void add(std::int64_t now_ns, std::int64_t delay_ns) noexcept {
    if (now_ns >= ends_ns_) {
      before_ns_ = now_ns < ends_ns_ + kWindowNs ? now_in_ns_ : TickTime::kNotMeasured;
      now_in_ns_ = TickTime::kNotMeasured;
      ends_ns_ = now_ns + kWindowNs;
    }
    now_in_ns_ = std::max(now_in_ns_, delay_ns);
  }
  [[nodiscard]] std::int64_t longest_ns() const noexcept {
    return std::max(now_in_ns_, before_ns_);
  }

 private:
  std::int64_t now_in_ns_ = TickTime::kNotMeasured, before_ns_ = TickTime::kNotMeasured;
  std::int64_t ends_ns_ = 0;  // of the present window
};

}  // namespace clearance
