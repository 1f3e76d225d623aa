#include "monitor/intake/slow_inputs.hpp"

#include <gtest/gtest.h>

#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

// The number of poses, of 100 at this interval, that are found too slow.
int found(std::int64_t interval_ns) {
  SlowIntervals slow({20 * kMillisecond});
  int times = 0;
  for (int i = 1; i <= 100; ++i) {
    const auto interval = slow.note(0, test::kStart + i * interval_ns);
    times += interval.has_value();
    EXPECT_EQ(interval.value_or(interval_ns), interval_ns);
  }
  return times;
}

TEST(SlowInputs, AreFoundOnceAndOnlyWhenTheyAreSlowerThanTheLimit) {
  EXPECT_EQ(found(33 * kMillisecond), 1);
  EXPECT_EQ(found(20 * kMillisecond), 0);
  EXPECT_EQ(found(kMillisecond), 0);
}

TEST(SlowInputs, AreNotFoundInAPauseOrLostBatches) {
  SlowIntervals slow({20 * kMillisecond});
  std::int64_t stamp = test::kStart;
  for (int i = 0; i < 1000; ++i) {
    EXPECT_FALSE(slow.note(0, stamp += (i % 5 == 0 ? 10 : 500) * kMillisecond));
  }
  EXPECT_FALSE(slow.note(99, stamp)) << "no such object";
}

TEST(SlowInputs, SayWhichLimitWouldFit) {
  EXPECT_EQ(fitting_age_limit_ms(33 * kMillisecond), 70);
  EXPECT_EQ(fitting_age_limit_ms(100 * kMillisecond), 200);
}

}  // namespace
}  // namespace clearance
