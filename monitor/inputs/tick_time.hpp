// The time that a tick is told. It only ever goes forwards, at the rate of this machine's steady
// clock, which cannot be stepped.
#pragma once

#include <cstdint>

namespace clearance {

struct TickTime {
  // CLOCK_REALTIME as it was when the daemon started, plus the time that has passed since. A tick
  // that is told less than the one before is told that an unknown time has passed: every pose is
  // late until the next one comes.
  std::int64_t now_ns = 0;
  // CLOCK_REALTIME less `now_ns`: 0 until this machine's clock is stepped.
  std::int64_t clock_offset_ns = 0;

  TickTime() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a time on a clock that was never stepped
  TickTime(std::int64_t now, std::int64_t clock_offset = 0) noexcept
      : now_ns(now), clock_offset_ns(clock_offset) {}
};

}  // namespace clearance
