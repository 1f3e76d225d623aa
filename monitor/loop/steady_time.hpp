// The tick's time from the clocks of this machine: CLOCK_REALTIME at the first reading plus the
// progress of CLOCK_BOOTTIME since then. CLOCK_BOOTTIME cannot be stepped, and it runs while the
// machine sleeps.
#pragma once

#include <cstdint>

#include "monitor/inputs/tick_time.hpp"
#include "monitor/loop/ports.hpp"

namespace clearance {

class SteadyTime {
 public:
  // Smaller steps of CLOCK_REALTIME cannot be told from the time between reading two clocks; a sum
  // of several can.
  static constexpr std::int64_t kLeastStepNs = 100'000;

  [[nodiscard]] TickTime read(Clock& clock) noexcept;
  // The number of steps of CLOCK_REALTIME since the first reading.
  [[nodiscard]] std::uint64_t steps() const noexcept { return steps_; }

 private:
  bool started_ = false;
  std::int64_t start_offset_ns_ = 0;  // CLOCK_REALTIME minus CLOCK_BOOTTIME at the first reading
  std::int64_t offset_ns_ = 0;        // and now
  std::uint64_t steps_ = 0;
};

}  // namespace clearance
