#include "monitor/intake/stamp_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "monitor/inputs/elapsed.hpp"

namespace clearance {

std::int64_t StampCheck::time_of(std::int64_t stamp_ns, std::int64_t sent_ns, RosStamps wanted,
                                 OtherClock other) noexcept {
  const bool is_replaced =
      other == OtherClock::kReplaced &&
      std::max(elapsed(stamp_ns, sent_ns), elapsed(sent_ns, stamp_ns)) > kOtherClockOfLogNs;
  return wanted == RosStamps::kSent || stamp_ns == 0 || is_replaced ? sent_ns : stamp_ns;
}

std::int64_t StampCheck::time_of(std::int64_t stamp_ns, std::int64_t sent_ns, RosStamps wanted,
                                 OtherClock other, TopicCounts& counts, Outlet& out,
                                 const std::function<Whose()>& whose) {
  const std::int64_t time_ns = time_of(stamp_ns, sent_ns, wanted, other);
  if (wanted == RosStamps::kSent) return time_ns;
  if (stamp_ns == 0) {
    ++counts.unstamped;
    return time_ns;
  }
  const bool is_log = other == OtherClock::kReplaced;
  const std::int64_t difference_ns = stamp_ns - sent_ns;
  if (std::abs(difference_ns) <= (is_log ? kOtherClockOfLogNs : kOtherClockNs)) {
    if (other_clock_ > 0) other_clock_ = 0;
    return time_ns;
  }
  if (counts.of_another_clock++ == 0) counts.clock_difference_ns = difference_ns;
  if (is_log) return time_ns;
  if (other_clock_ >= 0 && ++other_clock_ == kOtherClockMessages) {
    other_clock_ = -1;
    const Whose said = whose();
    out.tell(News(lines::kOtherClock, said.messages, 1e-9 * static_cast<double>(difference_ns),
                  said.key));
  }
  return time_ns;
}

}  // namespace clearance
