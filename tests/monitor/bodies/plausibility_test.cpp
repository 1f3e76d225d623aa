// Poses that contradict the cell or each other, tested through the tick.
#include "monitor/inputs/plausibility.hpp"

#include <gtest/gtest.h>

#include "tests/monitor/tick/two_balls.hpp"

namespace clearance {
namespace {

using test::balls_of_speed;
using test::kStart;
using test::kTick;
using test::rejected;
using test::with_twist;

// The status of the pair after a pose of the first ball.
PairStatus status_at(Monitor& monitor, double x, int tick) {
  return test::tick_with(monitor, 0, test::at(x, 0, 0), kStart + tick * kTick).pairs[0].status;
}

TEST(Plausibility, JumpMakesThePairUnknownInTheSameTick) {
  const Scene scene = balls_of_speed(2.0);
  Monitor monitor(scene);
  test::tick_with(monitor, 0, test::at(0, 0, 0), kStart);
  const Report& report = test::tick_with(monitor, 0, test::at(-0.5, 0, 0), kStart + kTick);
  EXPECT_EQ(rejected(monitor, Reject::kTooFast), 1u);
  EXPECT_EQ(report.pairs[0].status, PairStatus::kUnknown);
  EXPECT_EQ(report.lower_all, -kInfinity);
  EXPECT_TRUE(monitor.input_age(0).contradicted);
}

TEST(Plausibility, PoseIsTakenOnceTheObjectCanHaveGotThereAndKnownAnAgeLimitLater) {
  const Scene scene = balls_of_speed(2.0);
  Monitor monitor(scene);
  test::tick_with(monitor, 0, test::at(0, 0, 0), kStart);
  int tick = 1;
  while (status_at(monitor, -0.5, tick) == PairStatus::kUnknown) ASSERT_LT(++tick, 1000);
  EXPECT_NEAR(tick, 230 + 20, 1) << "0.5 m at 2 m/s, less the age limit, and that";
  EXPECT_FALSE(monitor.input_age(0).contradicted);
}

TEST(Plausibility, PlaceThatTheObjectCannotReachSoonIsTakenAfterTenSeconds) {
  for (const double speed : {2.0, kInfinity}) {
    const Scene scene = balls_of_speed(speed);
    Monitor monitor(scene);
    test::tick_with(monitor, 0, test::at(50'000, 0, 0), kStart);
    int tick = 1;
    while (status_at(monitor, 0.1, tick) == PairStatus::kUnknown) ASSERT_LT(++tick, 11'000);
    EXPECT_NEAR(tick, 10'000 + 20, 2);
  }
}

TEST(Plausibility, TwoWildPosesWithSilenceBetweenAreNotAPlaceWhereItStays) {
  const Scene scene = balls_of_speed(2.0);
  Monitor monitor(scene);
  (void)status_at(monitor, 0.0, 0);
  EXPECT_EQ(status_at(monitor, -20'000.0, 1), PairStatus::kUnknown);
  for (const int tick : {11'000, 11'001, 11'021, 11'022}) {
    EXPECT_EQ(status_at(monitor, -20'000.0, tick), PairStatus::kUnknown) << tick;
  }
}

TEST(Plausibility, PosesThatAlternateAreNeverKnown) {
  const Scene scene = balls_of_speed(2.0);
  Monitor monitor(scene);
  test::tick_with(monitor, 0, test::at(0, 0, 0), kStart);
  for (int tick = 1; tick < 15'000; ++tick) {
    ASSERT_EQ(status_at(monitor, tick % 2 == 0 ? 0.0 : -0.5, tick), PairStatus::kUnknown) << tick;
  }
}

TEST(Plausibility, OneWildPoseCostsAnAgeLimit) {
  const Scene scene = balls_of_speed(2.0);
  Monitor monitor(scene);
  test::tick_with(monitor, 0, test::at(0, 0, 0), kStart);
  EXPECT_EQ(status_at(monitor, -20'000.0, 1), PairStatus::kUnknown);
  for (int tick = 2; tick <= 30; ++tick) {
    ASSERT_EQ(status_at(monitor, 0.001, tick),
              tick <= 21 ? PairStatus::kUnknown : PairStatus::kConverged)
        << tick;
  }
}

TEST(Plausibility, ManySmallStepsAreHeldAgainstTheSpeedAsWell) {
  const Scene scene = balls_of_speed(2.0);
  for (const double speed : {1.0, 2.0, 2.4, 38.0}) {
    Monitor monitor(scene);
    for (int tick = 0; tick < 1500; ++tick) (void)status_at(monitor, 1e-3 * speed * tick, tick);
    EXPECT_EQ(rejected(monitor, Reject::kTooFast) > 0, speed > 2.34) << speed;
  }
}

TEST(Plausibility, NoiseOfAPoseIsNoSpeed) {
  const Scene scene = balls_of_speed(2.0);
  Monitor monitor(scene);
  Random random(5);
  for (int tick = 0; tick < 5000; ++tick) {
    ASSERT_EQ(status_at(monitor, random.uniform(-0.01, 0.01), tick), PairStatus::kConverged);
  }
}

TEST(Plausibility, LeapBeyondAnyCellIsRefusedWithoutAStatedSpeed) {
  const Scene scene = balls_of_speed(kInfinity);
  Monitor monitor(scene);
  test::tick_with(monitor, 0, test::at(0, 0, 0), kStart);
  for (int tick = 1; tick < 10; ++tick) {
    const Report& report =
        test::tick_with(monitor, 0, test::at(-20'000, 0, 0), kStart + tick * kTick);
    ASSERT_EQ(report.pairs[0].status, PairStatus::kUnknown);
    ASSERT_EQ(report.lower_all, -kInfinity);
  }
}

// A vertex at 1 m from the axis moves by 2 m.
TEST(Plausibility, TurnIsJudgedByTheBodysOwnPoints) {
  Scene scene = test::cell_of({test::moving("bar", {test::block(Vec3(1, 0.1, 0.1))}),
                               test::fixed("b", {test::ball(0.1)}, test::at(3, 0, 0))});
  scene.objects[0].max_speed = 2.0;
  scene.objects[0].may_jump = false;
  Monitor monitor(scene);
  Pose turned;
  turned.orientation = Eigen::AngleAxisd(3.0, Vec3::UnitZ());
  test::tick_with(monitor, 0, Pose{}, kStart);
  test::tick_with(monitor, 0, turned, kStart + kTick);
  EXPECT_EQ(rejected(monitor, Reject::kTooFast), 1u);
  turned.orientation = Eigen::AngleAxisd(0.02, Vec3::UnitZ());
  test::tick_with(monitor, 0, turned, kStart + kTick);
  EXPECT_EQ(rejected(monitor, Reject::kTooFast), 1u);
}

TEST(Plausibility, ImpossibleTwistIsRefused) {
  for (const double stated : {2.0, kInfinity}) {
    const Scene scene = balls_of_speed(stated);
    Monitor monitor(scene);
    PoseSample sample = with_twist(test::at(0, 0, 0), Vec3(1e9, 0, 0), kStart);
    const Report& report = monitor.tick(std::span(&sample, 1), kStart);
    EXPECT_EQ(report.pairs[0].status, PairStatus::kUnknown) << "nothing else was ever heard";
    EXPECT_EQ(rejected(monitor, Reject::kTooFast), 1u);
    sample = with_twist(test::at(0, 0, 0), Vec3(2.9, 0, 0), kStart + 21 * kTick);
    EXPECT_EQ(monitor.tick(std::span(&sample, 1), kStart + 21 * kTick).unknown, 0u);
  }
}

TEST(Plausibility, HalfSpaceIsJudgedByItsFrame) {
  Scene scene = test::cell_of({test::moving("floor", {test::floor()}),
                               test::fixed("b", {test::ball(0.1)}, test::at(0, 0, 1))});
  scene.objects[0].max_speed = 2.0;
  scene.objects[0].may_jump = false;
  Monitor monitor(scene);
  test::tick_with(monitor, 0, Pose{}, kStart);
  test::tick_with(monitor, 0, test::at(0, 0, -5), kStart + kTick);
  EXPECT_EQ(rejected(monitor, Reject::kTooFast), 1u);
}

TEST(Plausibility, ObjectThatMayJumpIsTakenAsItComes) {
  Scene scene = balls_of_speed(2.0);
  scene.objects[0].may_jump = true;
  Monitor monitor(scene);
  test::tick_with(monitor, 0, test::at(0, 0, 0), kStart);
  const Report& report = test::tick_with(monitor, 0, test::at(0.5, 0, 0), kStart + kTick);
  EXPECT_NEAR(report.pairs[0].distance, 0.3, 1e-9);
}

TEST(Plausibility, SensorThatNeverRepeatsItselfIsFrozenWhenItDoes) {
  Scene scene = balls_of_speed(2.0);
  scene.objects[0].frozen_limit_ns = 30 * kTick;
  Monitor monitor(scene);
  for (int tick = 0; tick <= 60; ++tick) {
    const Report& report =
        test::tick_with(monitor, 0, test::at(0.001, 0, 0), kStart + tick * kTick);
    ASSERT_EQ(report.pairs[0].status, tick <= 30 ? PairStatus::kConverged : PairStatus::kUnknown)
        << tick;
  }
  (void)status_at(monitor, 0.0011, 61);
  EXPECT_EQ(status_at(monitor, 0.0012, 61 + 21), PairStatus::kConverged);
}

}  // namespace
}  // namespace clearance
