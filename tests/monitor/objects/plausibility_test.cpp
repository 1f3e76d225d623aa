// Poses that contradict the cell or themselves, through the tick.
#include "monitor/objects/plausibility.hpp"

#include <gtest/gtest.h>

#include "tests/monitor/two_balls.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

std::uint64_t rejected(const Monitor& monitor, Reject cause) {
  return monitor.rejected(0)[static_cast<std::size_t>(cause)];
}

Scene balls_of_speed(double max_speed) {
  Scene scene = test::two_balls();
  scene.objects[0].may_jump = false;
  scene.objects[0].max_speed = max_speed;
  return scene;
}

PoseSample with_twist(const Pose& pose, const Vec3& linear, std::int64_t stamp_ns) {
  PoseSample sample = test::sample(0, pose, stamp_ns);
  sample.has_twist = true;
  sample.twist.linear = linear;
  return sample;
}

TEST(Plausibility, JumpIsRefusedAndThePairIsStaleInTheSameTick) {
  const Scene scene = balls_of_speed(2.0);
  Monitor monitor(scene);
  test::tick_with(monitor, 0, test::at(0, 0, 0), kStart);
  const Report& report = test::tick_with(monitor, 0, test::at(-0.5, 0, 0), kStart + kTick);
  EXPECT_EQ(rejected(monitor, Reject::kTooFast), 1u);
  EXPECT_EQ(report.pairs[0].status, PairStatus::kStale);
  EXPECT_NEAR(report.pairs[0].lower, 0.8 - 2.0 * 0.001, 1e-9);
  EXPECT_FALSE(report.minimum_certified);
  EXPECT_TRUE(monitor.input_age(0).contradicted);
}

TEST(Plausibility, PoseIsTakenOnceTheObjectCanHaveGotThere) {
  const Scene scene = balls_of_speed(2.0);
  Monitor monitor(scene);
  test::tick_with(monitor, 0, test::at(0, 0, 0), kStart);
  std::int64_t ticks = 1;
  while (
      test::tick_with(monitor, 0, test::at(-0.5, 0, 0), kStart + ticks * kTick).pairs[0].status ==
      PairStatus::kStale) {
    ASSERT_LT(++ticks, 1000);
  }
  EXPECT_EQ(ticks, 230) << "0.5 m at 2 m/s, less the age limit";
  EXPECT_FALSE(monitor.input_age(0).contradicted);
}

TEST(Plausibility, OneWildPoseCostsOneTick) {
  const Scene scene = balls_of_speed(2.0);
  Monitor monitor(scene);
  test::tick_with(monitor, 0, test::at(0, 0, 0), kStart);
  test::tick_with(monitor, 0, test::at(-20'000, 0, 0), kStart + kTick);
  const Report& report = test::tick_with(monitor, 0, test::at(0.001, 0, 0), kStart + 2 * kTick);
  EXPECT_EQ(report.pairs[0].status, PairStatus::kConverged);
  EXPECT_NEAR(report.pairs[0].distance, 0.799, 1e-9);
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

// A corner at 1 m from the axis moves by 2 m.
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
    sample.twist.linear = Vec3(2.9, 0, 0);
    EXPECT_EQ(monitor.tick(std::span(&sample, 1), kStart).unknown, 0u);
  }
}

TEST(Plausibility, PoseThatStaysWhileItsTwistSaysThatItMovesIsFrozen) {
  const Scene scene = balls_of_speed(2.0);
  Monitor monitor(scene);
  int ticks = 0;
  for (PairStatus status = PairStatus::kConverged; status != PairStatus::kStale; ++ticks) {
    ASSERT_LT(ticks, 100);
    const std::int64_t now = kStart + ticks * kTick;
    const PoseSample sample = with_twist(test::at(0, 0, 0), Vec3(1, 0, 0), now);
    status = monitor.tick(std::span(&sample, 1), now).pairs[0].status;
  }
  EXPECT_NEAR(ticks, 42, 1) << "it claims to have gone 40 mm: as far as it goes in its age limit";
  EXPECT_GE(rejected(monitor, Reject::kFrozen), 1u);
}

TEST(Plausibility, ObjectThatMayJumpIsTakenAsItComes) {
  Scene scene = balls_of_speed(2.0);
  scene.objects[0].may_jump = true;
  Monitor monitor(scene);
  test::tick_with(monitor, 0, test::at(0, 0, 0), kStart);
  const Report& report = test::tick_with(monitor, 0, test::at(0.5, 0, 0), kStart + kTick);
  EXPECT_NEAR(report.pairs[0].distance, 0.3, 1e-9);
}

TEST(Plausibility, ObjectAtRestIsNotFrozen) {
  const Scene scene = balls_of_speed(2.0);
  Monitor monitor(scene);
  for (int tick = 0; tick < 5000; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    const PoseSample sample = with_twist(test::at(0, 0, 0), Vec3(0.015, 0, 0), now);
    ASSERT_EQ(monitor.tick(std::span(&sample, 1), now).pairs[0].status, PairStatus::kConverged);
  }
}

TEST(Plausibility, SensorThatNeverRepeatsItselfIsFrozenWhenItDoes) {
  Scene scene = balls_of_speed(2.0);
  scene.objects[0].frozen_limit_ns = 30 * kTick;
  Monitor monitor(scene);
  for (int tick = 0; tick <= 60; ++tick) {
    const Report& report =
        test::tick_with(monitor, 0, test::at(0.001, 0, 0), kStart + tick * kTick);
    ASSERT_EQ(report.pairs[0].status, tick <= 30 ? PairStatus::kConverged : PairStatus::kStale)
        << tick;
  }
  EXPECT_EQ(
      test::tick_with(monitor, 0, test::at(0.0011, 0, 0), kStart + 61 * kTick).pairs[0].status,
      PairStatus::kConverged);
}

}  // namespace
}  // namespace clearance
