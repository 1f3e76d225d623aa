// The time of a simulation while other threads hear of it.
//
// Oracle: the stamps that were heard before the tick asked for its time.
#include "monitor/inputs/simulated_time.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "tests/shared/random.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000, kSecond = 1000 * kMillisecond;

// Three threads: messages of the clock and joints, frames, and the tick.
TEST(SimulatedTime, IsNeverBehindAStampThatATickUses) {
  constexpr std::int64_t kStep = 10 * kMillisecond;
  SimulatedTime time;
  std::atomic<std::int64_t> clock{kSecond}, heard{0};
  std::atomic<bool> ends{false};
  time.note(clock, 1, 1);
  std::thread frames([&] {
    Random random(3);
    while (!ends) time.lead(clock - random.integer(-10, 3) * kMillisecond);
  });
  std::thread joints([&] {
    for (std::int64_t i = 1; i < 100'000; ++i) {
      time.note(clock + kStep, i, i);
      clock += kStep;
      const std::int64_t stamp = clock + i % 11 * kMillisecond;
      time.lead(stamp);
      heard = stamp;
    }
    ends = true;
  });
  std::int64_t behind = 0;
  while (!ends) {
    const std::int64_t stamp = heard;
    behind += time.tick_time(0).now_ns < stamp;  // it does not go on between two messages
  }
  frames.join();
  joints.join();
  EXPECT_EQ(behind, 0);
}

}  // namespace
}  // namespace clearance
