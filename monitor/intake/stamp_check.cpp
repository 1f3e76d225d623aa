#include "monitor/intake/stamp_check.hpp"

#include <fmt/format.h>

#include <cstdlib>

namespace clearance {

std::int64_t StampCheck::time_of(std::int64_t stamp_ns, std::int64_t sent_ns, RosStamps wanted,
                                 OtherClock other, TopicCounts& counts, Outlet& out,
                                 const std::function<Whose()>& whose) {
  if (wanted == RosStamps::kSent) return sent_ns;
  if (stamp_ns == 0) {
    ++counts.unstamped;
    return sent_ns;
  }
  const bool is_log = other == OtherClock::kReplaced;
  const std::int64_t difference_ns = stamp_ns - sent_ns;
  if (std::abs(difference_ns) <= (is_log ? kOtherClockOfLogNs : kOtherClockNs)) {
    if (other_clock_ > 0) other_clock_ = 0;
    return stamp_ns;
  }
  if (counts.of_another_clock++ == 0) counts.clock_difference_ns = difference_ns;
  if (is_log) return sent_ns;
  if (other_clock_ >= 0 && ++other_clock_ == kOtherClockMessages) {
    other_clock_ = -1;
    const Whose said = whose();
    out.tell(
        {.cause = News::Cause::kOtherClock,
         .text = fmt::format("{} are stamped {:+.3f} s off the time at which they are sent: by "
                             "a clock of their own, as of a simulation (use_sim_time); {} "
                             "would take the time at which they are sent",
                             said.messages, 1e-9 * static_cast<double>(difference_ns), said.key)});
  }
  return stamp_ns;
}

}  // namespace clearance
