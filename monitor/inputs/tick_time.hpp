// The time that is passed to a tick. It follows this machine's steady clock, which cannot be
// stepped, and never goes backwards.
#pragma once

#include <cstdint>

namespace clearance {

struct TickTime {
  // CLOCK_REALTIME at the start of the daemon, plus the time that has passed since. Or the time of
  // a simulation (SimulatedTime), in which all stamps then are. A value below that of the tick
  // before means that an unknown time has passed. Every pose is then late until the next one comes.
  std::int64_t now_ns = 0;
  // CLOCK_REALTIME minus `now_ns`. It becomes nonzero when this machine's clock is stepped
  // while the daemon runs.
  std::int64_t clock_offset_ns = 0;
  // The longest that reports took lately from the time of their tick until they were handed to DDS,
  // as this machine has measured it: the report of this tick is expected to take no longer. 0 where
  // nothing is published; kNotMeasured.
  std::int64_t report_delay_ns = 0;
  static constexpr std::int64_t kNotMeasured = -1;

  TickTime() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a time on a clock that was never stepped
  TickTime(std::int64_t now, std::int64_t clock_offset = 0, std::int64_t report_delay = 0) noexcept
      : now_ns(now), clock_offset_ns(clock_offset), report_delay_ns(report_delay) {}
};

}  // namespace clearance
