// How a joint stops. Oracle: a table's rows themselves, one by one.
#include "config/scene/stopping.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/shared/random.hpp"

namespace clearance {
namespace {

// Up to four rows for a speed, as a table has them for several loads; neither times nor distances
// rise with the speed.
std::vector<StopPoint> random_table(Random& random) {
  std::vector<StopPoint> table;
  const int speeds = random.integer(1, 6);
  for (int i = 0; i < speeds; ++i) {
    const double speed = random.log_uniform(0.01, 5.0);
    const int rows = random.integer(1, 4);
    for (int row = 0; row < rows; ++row) {
      const double time = random.uniform(0.05, 0.8);
      table.push_back({speed, random.uniform(0.1, 1.0) * speed * time, time});
    }
  }
  return table;
}

// The greatest printed value up to a speed.
double printed(const std::vector<StopPoint>& table, double speed, double StopPoint::*value) {
  double greatest = 0.0;
  for (const StopPoint& point : table)
    if (point.speed <= speed) greatest = std::max(greatest, point.*value);
  return greatest;
}

std::vector<double> speeds_around(const std::vector<StopPoint>& table, Random& random) {
  std::vector<double> speeds;
  for (const StopPoint& point : table) {
    for (const double share : {1.0 - 0x1p-52, 1.0, 1.0 + 0x1p-51, 0.9, 1.1})
      speeds.push_back(share * point.speed);
  }
  for (int i = 0; i < 40; ++i) speeds.push_back(random.log_uniform(1e-3, 50.0));
  std::ranges::sort(speeds);
  return speeds;
}

TEST(JointStop, IsNeverBelowAPrintedValueOfTheSameOrALowerSpeed) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const std::vector<StopPoint> table = random_table(random);
    const JointStop stop = JointStop::by_table(table);
    for (const double speed : speeds_around(table, random)) {
      ASSERT_GE(stop.distance(speed), printed(table, speed, &StopPoint::distance)) << speed;
      ASSERT_GE(stop.time(speed), printed(table, speed, &StopPoint::time)) << speed;
    }
  }
}

TEST(JointStop, NeverFallsAsTheSpeedRises) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const std::vector<StopPoint> table = random_table(random);
    const double rate = random.log_uniform(0.1, 20.0);
    for (const JointStop& stop : {JointStop::by_table(table), JointStop::by_deceleration(rate),
                                  JointStop::by_time(1.0 / rate)}) {
      double distance = 0.0, time = 0.0;
      for (const double speed : speeds_around(table, random)) {
        ASSERT_GE(stop.distance(speed), distance) << speed;
        ASSERT_GE(stop.time(speed), time) << speed;
        distance = stop.distance(speed);
        time = stop.time(speed);
      }
    }
  }
}

// A table that stopped a robot at rest, or far beyond its rows, would allow nothing.
TEST(JointStop, IsNoLongerThanTheNextPrintedOneAsks) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const std::vector<StopPoint> table = random_table(random);
    const JointStop stop = JointStop::by_table(table);
    const double last = std::ranges::max(table, {}, &StopPoint::speed).speed;
    for (const double speed : speeds_around(table, random)) {
      double next = last;
      for (const StopPoint& point : table)
        if (point.speed >= speed) next = std::min(next, point.speed);
      if (speed > last) continue;
      ASSERT_LE(stop.distance(speed), printed(table, next, &StopPoint::distance)) << speed;
      ASSERT_EQ(stop.time(speed), printed(table, next, &StopPoint::time)) << speed;
    }
    EXPECT_EQ(stop.distance(0.0), 0.0);
    EXPECT_EQ(stop.time(0.0), 0.0);
  }
}

TEST(JointStop, HasThePrintedValuesAtThePrintedSpeeds) {
  const JointStop stop = JointStop::by_table({{3.0, 0.5, 0.4}, {1.0, 0.15, 0.3}, {2.0, 0.3, 0.35}});
  EXPECT_EQ(stop.distance(1.0), 0.15);
  EXPECT_EQ(stop.distance(2.0), 0.3);
  EXPECT_EQ(stop.distance(3.0), 0.5);
  EXPECT_EQ(stop.time(2.0), 0.35);
  EXPECT_NEAR(stop.distance(0.5), 0.075, 1e-12) << "half the speed, half the distance";
  EXPECT_EQ(stop.time(0.5), 0.3);
  EXPECT_NEAR(stop.distance(2.5), 2.5 * 0.5 / 3.0, 1e-12) << "by the longer quotient";
  EXPECT_EQ(stop.time(2.5), 0.4);
}

// A stop from a higher speed may be printed as shorter: joint 2 of a TM5-700 has 600, 516, 657 ms.
TEST(JointStop, OfATableThatIsNotMonotoneIsItsEnvelope) {
  const JointStop stop =
      JointStop::by_table({{1.0, 0.3, 0.600}, {2.0, 0.25, 0.516}, {3.0, 0.9, 0.657}});
  EXPECT_EQ(stop.time(2.0), 0.600);
  EXPECT_EQ(stop.distance(2.0), 0.3);
  EXPECT_EQ(stop.distance(1.5), 0.3);
  EXPECT_EQ(stop.time(2.5), 0.657);
}

// The rows of all loads have one speed. Once, the first of them counted below it.
TEST(JointStop, OfSeveralRowsWithOneSpeedIsTheWorst) {
  const JointStop stop = JointStop::by_table({{1.0, 0.1, 0.5}, {1.0, 0.3, 0.4}, {1.0, 0.2, 0.6}});
  ASSERT_EQ(stop.points().size(), 1u);
  EXPECT_EQ(stop.distance(1.0), 0.3);
  EXPECT_EQ(stop.time(1.0), 0.6);
  EXPECT_NEAR(stop.distance(0.5), 0.15, 1e-12);
}

TEST(JointStop, AboveTheLastPrintedSpeedGrowsAsUnderAConstantDeceleration) {
  const JointStop stop = JointStop::by_table({{2.0, 0.4, 0.5}});
  EXPECT_NEAR(stop.distance(3.0), 0.4 * 2.25, 1e-12);
  EXPECT_NEAR(stop.time(3.0), 0.75, 1e-12);
}

TEST(JointStop, ByADecelerationOrATimeHasItsClosedForm) {
  const JointStop braked = JointStop::by_deceleration(4.0);
  EXPECT_NEAR(braked.distance(2.0), 0.5, 1e-12);
  EXPECT_NEAR(braked.time(2.0), 0.5, 1e-12);
  EXPECT_GE(braked.distance(2.0), 0.5);
  const JointStop late = JointStop::by_time(0.3);
  EXPECT_NEAR(late.distance(2.0), 0.6, 1e-12) << "it goes on as fast as at first";
  EXPECT_EQ(late.time(2.0), 0.3);
  EXPECT_TRUE(late.points().empty());
}

}  // namespace
}  // namespace clearance
