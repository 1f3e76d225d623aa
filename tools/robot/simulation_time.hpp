// The time of a simulation: seconds since its start, and the stamps of its messages.
#pragma once

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "monitor/loop/ports.hpp"

namespace clearance {

// A stamp is CLOCK_REALTIME, and the motion follows CLOCK_MONOTONIC: a clock that is stepped moves
// no body. A stamp and its state of the bodies belong together exactly. To be used by any threads.
class SimulationTime {
 public:
  SimulationTime() : start_(SystemClock().monotonic_ns()) { follow(); }

  // Returns s since the start, and the stamp, of a time of CLOCK_MONOTONIC.
  [[nodiscard]] double seconds(std::int64_t monotonic_ns) const noexcept {
    return 1e-9 * static_cast<double>(monotonic_ns - start_);
  }
  [[nodiscard]] std::int64_t stamp(std::int64_t monotonic_ns) const noexcept {
    return monotonic_ns + ahead_.load(std::memory_order_relaxed);
  }
  // The seconds of a stamp, if no clock was stepped since.
  [[nodiscard]] double seconds_of_stamp(std::int64_t stamp_ns) const noexcept {
    return seconds(stamp_ns - ahead_.load(std::memory_order_relaxed));
  }

  // Finds out whether CLOCK_REALTIME was stepped; called now and then by one thread.
  void follow() noexcept {
    SystemClock clock;
    std::int64_t shortest = std::numeric_limits<std::int64_t>::max(), ahead = 0;
    // The thread may be interrupted between two readings of the clocks.
    for (int i = 0; i < kReadings; ++i) {
      const std::int64_t before = clock.monotonic_ns(), now = clock.realtime_ns();
      const std::int64_t took = clock.monotonic_ns() - before;
      if (took >= shortest) continue;
      shortest = took;
      ahead = now - before - took / 2;
    }
    const std::int64_t known = ahead_.load(std::memory_order_relaxed);
    if (std::llabs(ahead - known) > kStepNs + shortest) ahead_ = ahead;
  }

 private:
  static constexpr int kReadings = 5;
  static constexpr std::int64_t kStepNs = 1'000'000;

  std::int64_t start_;
  std::atomic<std::int64_t> ahead_{std::numeric_limits<std::int64_t>::min() / 2};
};

}  // namespace clearance
