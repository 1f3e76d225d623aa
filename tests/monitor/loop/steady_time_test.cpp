#include "monitor/loop/steady_time.hpp"

#include <gtest/gtest.h>

#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

using test::kStart;
constexpr std::int64_t kMillisecond = test::kTick;

// Each reading of a clock takes some time.
class TurnedClocks final : public Clock {
 public:
  std::int64_t realtime_ns() noexcept override { return kStart + wall_ahead + pass(); }
  std::int64_t monotonic_ns() noexcept override { return pass(); }
  std::int64_t steady_ns() noexcept override { return 77 * kMillisecond + pass(); }
  void sleep_until(std::int64_t) noexcept override {}

  std::int64_t now = 0, wall_ahead = 0, reading_takes = 20;

 private:
  std::int64_t pass() noexcept { return now += reading_takes; }
};

TEST(SteadyTime, BeginsAtTheWallClockAndGoesOnAtTheSteadyOne) {
  TurnedClocks clocks;
  SteadyTime time;
  const TickTime first = time.read(clocks);
  EXPECT_NEAR(static_cast<double>(first.now_ns - kStart), 0.0, 100.0);
  EXPECT_EQ(first.clock_offset_ns, 0);
  clocks.now += 5 * kMillisecond;
  EXPECT_NEAR(static_cast<double>(time.read(clocks).now_ns - first.now_ns), 5.0 * kMillisecond,
              100.0);
}

TEST(SteadyTime, StepsOfTheWallClockMoveTheOffsetOnly) {
  TurnedClocks clocks;
  SteadyTime time;
  std::int64_t before = time.read(clocks).now_ns;
  std::uint64_t steps = 0;
  for (const std::int64_t step : {-2000 * kMillisecond, 3'600'000 * kMillisecond,
                                  -3'600'000 * kMillisecond, 2000 * kMillisecond}) {
    clocks.wall_ahead += step;
    const TickTime now = time.read(clocks);
    EXPECT_NEAR(static_cast<double>(now.now_ns - before), 0.0, 200.0);
    EXPECT_NEAR(static_cast<double>(now.clock_offset_ns - clocks.wall_ahead), 0.0, 200.0);
    EXPECT_EQ(time.steps(), ++steps);
    before = now.now_ns;
  }
}

TEST(SteadyTime, ThreadHeldUpBetweenTwoReadingsIsNoStep) {
  TurnedClocks clocks;
  SteadyTime time;
  (void)time.read(clocks);
  clocks.reading_takes = 300 * kMillisecond;
  EXPECT_EQ(time.read(clocks).clock_offset_ns, 0);
  EXPECT_EQ(time.steps(), 0u);
}

TEST(SteadyTime, SmallStepsAddUp) {
  TurnedClocks clocks;
  SteadyTime time;
  (void)time.read(clocks);
  for (int i = 0; i < 50; ++i) {
    clocks.wall_ahead += SteadyTime::kLeastStepNs / 5;
    const TickTime now = time.read(clocks);
    EXPECT_NEAR(static_cast<double>(now.clock_offset_ns), static_cast<double>(clocks.wall_ahead),
                SteadyTime::kLeastStepNs + 100.0);
  }
  EXPECT_GE(time.steps(), 8u);
}

}  // namespace
}  // namespace clearance
