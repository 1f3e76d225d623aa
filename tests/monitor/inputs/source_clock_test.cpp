#include "monitor/inputs/source_clock.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

using test::kStart;
constexpr std::int64_t kMs = test::kTick;
constexpr std::int64_t kConfirmedMs = SourceClock::kConfirmedAfterNs / kMs;
constexpr SourceClock::Limits kLimits{.future_ns = 5 * kMs, .age_ns = 20 * kMs};

// A source and the machine that receives its poses. Times are in ms since the start, by a clock
// that is never stepped.
class StampStream {
 public:
  // Sets the offset of their clocks from that clock from now on, ms.
  void set_machine(std::int64_t ahead_ms) { machine_ms_ = ahead_ms; }
  void set_source(std::int64_t ahead_ms) { source_ms_ = ahead_ms; }
  void set_both(std::int64_t ahead_ms) { machine_ms_ = source_ms_ = ahead_ms; }
  // The apparent age of a pose, ms; negative if it appears to be from the future.
  std::int64_t age_ms(std::int64_t made_ms, std::int64_t comes_ms) {
    const TickTime time(kStart + comes_ms * kMs, machine_ms_ * kMs);
    const std::int64_t stamp = kStart + (made_ms + source_ms_) * kMs;
    return (time.now_ns - clock_.in_tick_time(stamp, time, kLimits)) / kMs;
  }

 private:
  SourceClock clock_;
  std::int64_t machine_ms_ = 0, source_ms_ = 0;
};

TEST(SourceClock, StampsAreOfThisMachinesClockAtFirst) {
  StampStream stream;
  stream.set_both(5000);
  EXPECT_EQ(stream.age_ms(100, 103), 3);
  EXPECT_EQ(stream.age_ms(101, 140), 39);
}

TEST(SourceClock, ProgramOfThisMachineIsFollowedHalfASecondAfterAStepAndNeverTooYoung) {
  for (const std::int64_t step : {-3'600'000, -2000, -30, 30, 2000, 3'600'000}) {
    StampStream stream;
    std::int64_t ms = 0;
    EXPECT_EQ(stream.age_ms(ms, ms + 1), 1);
    for (const std::int64_t ahead : {step, std::int64_t{0}}) {
      stream.set_both(ahead);
      const std::int64_t seems = 1 - (ahead == 0 ? -step : step);
      for (const std::int64_t end = ms + kConfirmedMs; ms < end; ++ms) {
        ASSERT_EQ(stream.age_ms(ms, ms + 1), seems) << step;
      }
      EXPECT_EQ(stream.age_ms(ms, ms + 1), 1) << step;
    }
  }
}

// A step ahead by slightly more than a stamp may be ahead. Some poses are on time by either clock.
TEST(SourceClock, ProgramOfThisMachineIsFollowedAfterAStepThatOnlySomeStampsShow) {
  StampStream stream;
  stream.set_both(10);
  EXPECT_EQ(stream.age_ms(0, 1), 1);
  stream.set_both(20);
  const auto latency = [](std::int64_t ms) { return ms * 5 % 9; };
  std::int64_t ms = 1;
  for (; stream.age_ms(ms, ms + latency(ms)) != latency(ms); ++ms) ASSERT_LT(ms, 600);
  EXPECT_GE(ms, kConfirmedMs);
  for (; ms < 1500; ++ms) ASSERT_EQ(stream.age_ms(ms, ms + latency(ms)), latency(ms));
}

TEST(SourceClock, PosesInFlightWhileTheClockIsSteppedKeepTheirAge) {
  for (const std::int64_t step : {-2000, 2000}) {
    StampStream stream;
    EXPECT_EQ(stream.age_ms(0, 1), 1);
    stream.set_machine(step);
    EXPECT_EQ(stream.age_ms(1, 8), 7) << step;
    EXPECT_EQ(stream.age_ms(2, 2002), 2000) << step << ": held up by as much as the clock went";
  }
}

TEST(SourceClock, OtherMachineIsNeverTakenForYoungerThanItIs) {
  for (const std::int64_t step : {-2000, 2000}) {
    StampStream stream;
    EXPECT_EQ(stream.age_ms(0, 1), 1);
    stream.set_machine(step);
    for (std::int64_t ms = 1; ms < 5000; ++ms) ASSERT_EQ(stream.age_ms(ms, ms + 1), 1) << step;
  }
}

TEST(SourceClock, SourceWhoseOwnClockIsSteppedIsLateOrFromTheFuture) {
  StampStream stream;
  EXPECT_EQ(stream.age_ms(0, 1), 1);
  stream.set_source(-2000);
  for (std::int64_t ms = 1; ms < 3000; ++ms) ASSERT_EQ(stream.age_ms(ms, ms + 1), 2001);
  stream.set_source(1000);
  for (std::int64_t ms = 3000; ms < 6000; ++ms) ASSERT_EQ(stream.age_ms(ms, ms + 1), -999);
}

// A source on another machine, whose clock is stepped by about as much as this one's. Its poses are
// then delayed, and among those that arrive at once some appear to be on time.
TEST(SourceClock, PosesHeldUpByTheDifferenceOfTwoStepsAreNotTakenForNew) {
  StampStream stream;
  EXPECT_EQ(stream.age_ms(0, 1), 1);
  stream.set_machine(1000);
  stream.set_source(1500);
  for (std::int64_t comes = 2000; comes < 8000; comes += 1000) {
    for (std::int64_t made = comes - 1000; made < comes; ++made) {
      ASSERT_EQ(stream.age_ms(made, comes), comes - made - 1500);
    }
  }
}

TEST(SourceClock, ExtremeStampsDoNotOverflow) {
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  for (const std::int64_t stamp : {kLeast, std::numeric_limits<std::int64_t>::max()}) {
    SourceClock clock;
    for (const std::int64_t offset : {std::int64_t{0}, kLeast / 2, -(kLeast / 2)}) {
      const std::int64_t at = clock.in_tick_time(stamp, TickTime(kStart, offset), kLimits);
      EXPECT_TRUE(stamp < 0 ? at < kStart : at > kStart);
    }
  }
}

}  // namespace
}  // namespace clearance
