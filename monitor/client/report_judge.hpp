// Judges every message of a tick that a client receives: whether it is handed out, whether it is
// good, and whether the client may still rely on the last good one (END_TO_END.md).
#pragma once

#include <cstdint>

#include "monitor/wire/report_check.hpp"

namespace clearance::client {

// "good", "nothing heard", "silent", ...
[[nodiscard]] const char* name(ReportError error) noexcept;

// Without a clock of its own: `at_ns` is of a clock that is never set.
class ReportJudge {
 public:
  struct Limits {
    std::int64_t old_after_ns = 0;       // ReportChecker's limit
    std::int64_t period_ns = 0;          // a good message counts so long; 0: two stated periods
    std::int64_t error_interval_ns = 0;  // two faulty messages within it hold fail-safe
  };
  // `address`: what messages for this client state.
  ReportJudge(const Limits& limits, std::uint64_t address)
      : limits_(limits), address_(address), checker_(limits.old_after_ns) {}

  // To be called with every message as it came. If it returns an error, the message is not to be
  // handed out.
  template <class Message>
  [[nodiscard]] ReportError refuse(const Message& message, std::int64_t at_ns) noexcept;
  // To be called with every message that is handed out, in order. `realtime_ns` is CLOCK_REALTIME.
  template <class Message>
  [[nodiscard]] ReportCheck check(const Message& message, std::int64_t realtime_ns,
                                  std::int64_t at_ns) noexcept;

  // Why no report may be relied on now; kGood: the last good one counts.
  [[nodiscard]] ReportError error(std::int64_t at_ns) const noexcept;
  // Two faulty messages came within the interval: error() stays until acknowledge().
  [[nodiscard]] bool is_held() const noexcept { return held_by_ != ReportError::kGood; }
  // Forgets the errors, and which daemon was heard before.
  void acknowledge() noexcept;

 private:
  void note(ReportError error, bool is_faulty, std::int64_t at_ns) noexcept;

  Limits limits_;
  std::uint64_t address_;
  ReportChecker checker_;
  std::int64_t limit_ns_ = limits_.old_after_ns;  // how long the last message counts
  std::int64_t good_until_ns_ = 0;                // of the last good message; 0: none
  ReportError failed_ = ReportError::kGood;       // since the last good message
  std::int64_t failed_ns_ = 0;                    // when
  std::int64_t fault_ns_ = 0;                     // the last faulty message; 0: none
  ReportError held_by_ = ReportError::kGood;
};

}  // namespace clearance::client
