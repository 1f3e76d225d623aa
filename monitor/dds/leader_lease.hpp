// The lease under which the leading one of two partners writes what has one leader.
//
// Its partner takes over half a period after a notice that has not come, and writes when it has led
// for a lease. So a leader that was stopped for a moment cannot know whether it still leads: it
// waits for a lease, too, and hears meanwhile who has taken over.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

namespace clearance {

// A leader counts as leading for so long after its last notice. With ticks of this period, two
// notices in a row would have to be late.
[[nodiscard]] constexpr std::int64_t leader_lease_ns(std::int64_t period_ns) noexcept {
  constexpr std::int64_t kLeast = 20'000'000;
  return std::max(kLeast, 2 * period_ns);
}

// All times are CLOCK_MONOTONIC of one machine.
class LeaderLease {
 public:
  explicit LeaderLease(std::int64_t period_ns) noexcept : lease_ns_(leader_lease_ns(period_ns)) {}

  [[nodiscard]] std::int64_t lease_ns() const noexcept { return lease_ns_; }
  // One thread: a notice was written, of a tick that is due then. One that has waited while this
  // daemon stood still is no sign that it led meanwhile.
  void noticed(std::int64_t now_ns, std::int64_t due_ns) noexcept {
    const std::int64_t at_ns = std::min(due_ns, now_ns);
    if (at_ns - noticed_ns_ >= writes_for_ns()) began_ns_ = now_ns;
    noticed_ns_ = at_ns;
  }
  // Any thread. True while this daemon may write what has one leader, if it has led the ticks since
  // that time and hears no other leader.
  [[nodiscard]] bool holds(std::int64_t now_ns, std::int64_t leads_since_ns) const noexcept {
    const std::int64_t noticed_ns = noticed_ns_;  // before `began_ns_`, which is written first
    return now_ns - noticed_ns < writes_for_ns() &&
           now_ns - std::max<std::int64_t>(began_ns_, leads_since_ns) > lease_ns_;
  }

 private:
  // Less than its lease, which the other one waits for.
  [[nodiscard]] std::int64_t writes_for_ns() const noexcept { return lease_ns_ * 3 / 4; }

  const std::int64_t lease_ns_;
  std::atomic<std::int64_t> noticed_ns_{0}, began_ns_{0};
};

}  // namespace clearance
