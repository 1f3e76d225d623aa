// Checks that a client should make before it believes a report: it must be fresh, and the next one
// of the same daemon. A reader that was held up gets the reports of that time one after another,
// and each of them looks like news.
#pragma once

#include <algorithm>
#include <cstdint>

#include "clearance.h"
#include "monitor/inputs/elapsed.hpp"

namespace clearance {

// Why a report must not be relied on, or why no report may.
enum class ReportError : std::uint8_t {
  kGood = 0,
  kNothingHeard = 1,    // no good report has come yet
  kSilent = 2,          // no good report has come in time
  kOld = 3,             // it was published too long ago, or is replayed
  kClocksDisagree = 4,  // it was published later than now
  kOtherSource = 5,     // it is not of the daemon of the one before, or of its partner
  kRepeated = 6,        // its cycle is not above that of the one before
  // The CRC is not the one that it states, or it states none, or it has a value of no daemon.
  kCorrupt = 7,
  kOtherAddress = 8,  // it was written for another domain, partition or topic
  kShare = 9,         // a share of the cell is not whole
};

// The result for one report.
struct ReportCheck {
  // Since it was published, by the client's clock. Negative: the clock of the daemon's machine is
  // ahead.
  std::int64_t age_ns = 0;
  bool is_old = false;           // it describes the past, not the present
  bool clocks_disagree = false;  // published later than now: its age means nothing
  // The report is not of the daemon of the one before, or of its partner: that was started again,
  // or two daemons publish.
  bool other_daemon = false;
  // The report is of another scene than the one before it, with other ids.
  bool other_scene = false;
  // Reports between the one before and this one. Partners that tick apart need not count alike:
  // between two lineages the time of the ticks counts, in periods that the report states. A tick is
  // told up to a period late, so the next cycle is missing none for two periods.
  std::uint64_t missed = 0;
  ReportError error = ReportError::kGood;  // by ReportJudge

  [[nodiscard]] bool fresh() const noexcept { return !is_old && !clocks_disagree; }
};

// The time until the next report, ns; 0: the report states none.
template <class Message>
[[nodiscard]] std::int64_t stated_period_ns(const Message& report) noexcept {
  constexpr std::int64_t kLongest = 1'000'000'000'000;  // sums of it do not overflow
  return std::clamp<std::int64_t>(report.period_ns, 0, kLongest);
}

class ReportChecker {
 public:
  // A report older than this is old. A report from the future by more than this shows that the
  // clocks disagree. On two machines the limit must be above the difference of their clocks.
  explicit ReportChecker(std::int64_t limit_ns) : limit_ns_(limit_ns) {}

  // To be called with every report, in the order in which they are taken; `realtime_ns` is
  // CLOCK_REALTIME when it was taken.
  // A stream of gradients needs a second checker.
  template <class Message>
  ReportCheck check(const Message& report, std::int64_t realtime_ns) noexcept {
    ReportCheck found;
    if (report.publish_ns != 0) found.age_ns = less(realtime_ns, report.publish_ns);  // 0: a replay
    found.is_old = found.age_ns > limit_ns_;
    found.clocks_disagree = found.age_ns < -limit_ns_;
    found.other_scene = cycle_ != 0 && report.scene_revision != revision_;
    // Replays have no number of a daemon: one that goes on with another scene is the same.
    const bool other_replay = report.daemon == 0 && found.other_scene && report.cycle != cycle_ + 1;
    const bool again = report.cycle <= cycle_ || other_replay;
    const bool has_partner = is_of_partner(report);
    const bool is_partner = has_partner && had_partner_;
    had_partner_ = has_partner;
    found.other_daemon = cycle_ != 0 && ((report.daemon != daemon_ && !is_partner) || again);
    if (cycle_ != 0 && !found.other_daemon) found.missed = missed_before(report);
    note_lineage(report);
    daemon_ = report.daemon;
    cycle_ = report.cycle;
    revision_ = report.scene_revision;
    return found;
  }

  // The daemon has sent this report, or a later one, before. Partners send each cycle twice, and
  // replays have no number of a daemon.
  template <class Message>
  [[nodiscard]] bool has_had(const Message& report) const noexcept {
    return report.daemon != 0 && report.daemon == daemon_ && report.cycle <= cycle_ &&
           !is_of_partner(report);
  }

 private:
  template <class Message>
  [[nodiscard]] static bool is_of_partner(const Message& report) noexcept {
    if constexpr (requires { report.partner; }) return *report.partner != '\0';
    return false;
  }

  template <class Message>
  [[nodiscard]] std::uint64_t missed_before(const Message& report) const noexcept {
    if constexpr (requires { report.lineage; }) {
      const std::int64_t period = stated_period_ns(report);
      const std::int64_t later = less(report.now_ns, now_ns_);
      const bool goes_on = report.cycle == cycle_ + 1 && later < 2 * period;
      if (report.lineage != lineage_ && period > 0 && !goes_on) {
        const std::int64_t steps = less(later, -(period / 2)) / period;
        return steps > 1 ? static_cast<std::uint64_t>(steps - 1) : 0;
      }
    }
    return report.cycle - cycle_ - 1;
  }
  template <class Message>
  void note_lineage(const Message& report) noexcept {
    if constexpr (requires { report.lineage; }) {
      lineage_ = report.lineage;
      now_ns_ = report.now_ns;
    }
  }

  std::int64_t limit_ns_;
  bool had_partner_ = false;  // the report before was one of two partners
  std::uint64_t daemon_ = 0, cycle_ = 0, revision_ = 0, lineage_ = 0;
  std::int64_t now_ns_ = 0;  // of the report before
};

}  // namespace clearance
