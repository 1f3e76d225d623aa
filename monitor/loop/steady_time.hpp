// The tick's time from the clocks of this machine: CLOCK_REALTIME as it was at the first reading,
// plus what CLOCK_BOOTTIME has gone on since, which cannot be stepped and goes on while the
// machine sleeps.
#pragma once

#include <cstdint>

#include "monitor/inputs/tick_time.hpp"
#include "monitor/loop/ports.hpp"

namespace clearance {

class SteadyTime {
 public:
  // Steps of CLOCK_REALTIME below this are not told apart from how long reading two clocks takes;
  // several of them together are.
  static constexpr std::int64_t kLeastStepNs = 100'000;

  [[nodiscard]] TickTime read(Clock& clock) noexcept;
  // How often CLOCK_REALTIME was stepped since the first reading.
  [[nodiscard]] std::uint64_t steps() const noexcept { return steps_; }

 private:
  bool started_ = false;
  std::int64_t start_offset_ns_ = 0;  // CLOCK_REALTIME less CLOCK_BOOTTIME at the first reading
  std::int64_t offset_ns_ = 0;        // and now
  std::uint64_t steps_ = 0;
};

}  // namespace clearance
