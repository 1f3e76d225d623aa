#include "monitor/inputs/source_clock.hpp"

#include "monitor/inputs/elapsed.hpp"

namespace clearance {

std::int64_t SourceClock::in_tick_time(std::int64_t stamp_ns, const TickTime& time,
                                       const Limits& limits) noexcept {
  if (!heard_) {
    heard_ = true;
    offset_ns_ = time.clock_offset_ns;
  }
  const std::int64_t by_old = less(stamp_ns, offset_ns_);
  if (offset_ns_ == time.clock_offset_ns) return by_old;
  const std::int64_t by_new = less(stamp_ns, time.clock_offset_ns);
  if (!confirms(by_new, by_old, time.now_ns, limits)) return by_old;
  offset_ns_ = time.clock_offset_ns;
  agrees_ = false;
  return by_new;
}

bool SourceClock::confirms(std::int64_t new_ns, std::int64_t old_ns, std::int64_t now_ns,
                           const Limits& limits) noexcept {
  const auto on_time = [&](std::int64_t stamp) {
    return elapsed(now_ns, stamp) <= limits.future_ns && elapsed(stamp, now_ns) <= limits.age_ns;
  };
  const bool only_new = on_time(new_ns) && !on_time(old_ns);
  const bool fits_both = agrees_ && on_time(new_ns) && new_ns < old_ns;
  if (only_new && !agrees_) agrees_since_ns_ = now_ns;
  agrees_ = only_new || fits_both;
  return only_new && elapsed(agrees_since_ns_, now_ns) >= kConfirmedAfterNs;
}

}  // namespace clearance
