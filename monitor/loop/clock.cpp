// The kernel's clocks through clock_gettime, which enters no kernel on common hardware (vDSO).
#include <cerrno>
#include <ctime>

#include "monitor/loop/ports.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kNsPerS = 1'000'000'000;

// This cannot fail for these clocks.
std::int64_t read(clockid_t clock) noexcept {
  timespec time{};
  clock_gettime(clock, &time);
  return std::int64_t{time.tv_sec} * kNsPerS + time.tv_nsec;
}

}  // namespace

std::int64_t SystemClock::realtime_ns() noexcept { return read(CLOCK_REALTIME); }
std::int64_t SystemClock::monotonic_ns() noexcept { return read(CLOCK_MONOTONIC); }
std::int64_t SystemClock::steady_ns() noexcept { return read(CLOCK_BOOTTIME); }

// The time is absolute, so that time spent before the call does not add up. A signal does not end
// the sleep early.
void SystemClock::sleep_until(std::int64_t monotonic_ns) noexcept {
  const timespec until{.tv_sec = monotonic_ns / kNsPerS, .tv_nsec = monotonic_ns % kNsPerS};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

void SystemClock::stay_awake_until(std::int64_t monotonic_ns) noexcept {
  while (this->monotonic_ns() < monotonic_ns) {
  }
}

}  // namespace clearance
