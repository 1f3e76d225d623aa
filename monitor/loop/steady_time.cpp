#include "monitor/loop/steady_time.hpp"

#include <algorithm>

namespace clearance {
namespace {

// Bounds of CLOCK_REALTIME minus CLOCK_BOOTTIME.
struct Offset {
  std::int64_t least, most;
};

// The first clock is read before and after the second one: a delay of the thread in between makes
// the bounds wide, but not wrong.
Offset offset_of(Clock& clock, std::int64_t& steady_ns) noexcept {
  const std::int64_t before = clock.steady_ns();
  const std::int64_t realtime = clock.realtime_ns();
  steady_ns = clock.steady_ns();
  return {realtime - steady_ns, realtime - before};
}

}  // namespace

TickTime SteadyTime::read(Clock& clock) noexcept {
  std::int64_t steady = 0;
  const Offset offset = offset_of(clock, steady);
  if (!started_) {
    started_ = true;
    start_offset_ns_ = offset_ns_ = offset.most;
  }
  if (offset.least > offset_ns_ + kLeastStepNs || offset.most < offset_ns_ - kLeastStepNs) {
    offset_ns_ = std::clamp(offset_ns_, offset.least, offset.most);
    ++steps_;
  }
  return {steady + start_offset_ns_, offset_ns_ - start_offset_ns_};
}

}  // namespace clearance
