// Poses that contradict the cell or themselves, through the tick.
#include "monitor/objects/plausibility.hpp"

#include <gtest/gtest.h>

#include <cmath>

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
    sample = with_twist(test::at(0, 0, 0), Vec3(2.9, 0, 0), kStart + 21 * kTick);
    EXPECT_EQ(monitor.tick(std::span(&sample, 1), kStart + 21 * kTick).unknown, 0u);
  }
}

TEST(Plausibility, PoseThatStaysWhileItsTwistSaysThatItMovesIsFrozen) {
  const Scene scene = balls_of_speed(2.0);
  Monitor monitor(scene);
  int ticks = 0;
  for (PairStatus status = PairStatus::kConverged; status != PairStatus::kUnknown; ++ticks) {
    ASSERT_LT(ticks, 100);
    const std::int64_t now = kStart + ticks * kTick;
    const PoseSample sample = with_twist(test::at(0, 0, 0), Vec3(1, 0, 0), now);
    status = monitor.tick(std::span(&sample, 1), now).pairs[0].status;
  }
  EXPECT_NEAR(ticks, 49, 1) << "it claims 48 mm: the way of its age limit and a sixth of itself";
  EXPECT_GE(rejected(monitor, Reject::kFrozen), 1u);
}

// Goes round a circle of 0.1 m at 1 m/s, turned by what the object turns about its own z axis.
PoseSample on_circle(std::int64_t stamp_ns) {
  const double angle = 10.0 * 1e-9 * static_cast<double>(stamp_ns - kStart);
  PoseSample sample = with_twist(test::at(0.1 * std::cos(angle), 0.1 * std::sin(angle), 0),
                                 Vec3(-std::sin(angle), std::cos(angle), 0), stamp_ns);
  sample.world_from_object.orientation = Eigen::AngleAxisd(angle, Vec3::UnitZ());
  sample.twist.angular = Vec3(0, 0, 10);
  return sample;
}

Scene bar_of_speed(double max_speed) {
  Scene scene = test::cell_of({test::moving("bar", {test::block(Vec3(0.2, 0.05, 0.05))}),
                               test::fixed("b", {test::ball(0.1)}, test::at(3, 0, 0))});
  scene.objects[0].max_speed = max_speed;
  scene.objects[0].may_jump = false;
  return scene;
}

// The first tick of `count` after which the object is unknown, else `count`.
int ticks_until_unknown(const Scene& scene, int count, auto&& sample_at) {
  Monitor monitor(scene);
  for (int tick = 0; tick < count; ++tick) {
    const PoseSample sample = sample_at(kStart + tick * kTick);
    (void)monitor.tick(std::span(&sample, 1), sample.stamp_ns);
    if (monitor.input_age(0).contradicted) return tick;
  }
  return count;
}

TEST(Plausibility, TwistThatIsOfThePosesIsTaken) {
  const Scene scene = bar_of_speed(4.0);
  EXPECT_EQ(ticks_until_unknown(scene, 5000, on_circle), 5000);
  const auto late = [](std::int64_t stamp_ns) {
    PoseSample sample = on_circle(stamp_ns);
    sample.twist = on_circle(stamp_ns - 15 * kTick).twist;
    return sample;
  };
  EXPECT_EQ(ticks_until_unknown(scene, 5000, late), 5000) << "by less than the age limit";
}

TEST(Plausibility, TwistThatLeadsElsewhereThanThePosesIsFoundOut) {
  const Scene scene = bar_of_speed(4.0);
  const auto reversed = [](std::int64_t stamp_ns) {
    PoseSample sample = on_circle(stamp_ns);
    sample.twist.linear *= -1.0;
    return sample;
  };
  EXPECT_LT(ticks_until_unknown(scene, 1000, reversed), 100);
  const auto without_turn = [](std::int64_t stamp_ns) {
    PoseSample sample = on_circle(stamp_ns);
    sample.twist.angular.setZero();
    return sample;
  };
  EXPECT_LT(ticks_until_unknown(scene, 1000, without_turn), 100);
  const auto in_its_own_frame = [](std::int64_t stamp_ns) {
    PoseSample sample = on_circle(stamp_ns);
    sample.twist.linear = Vec3(0, 1, 0);
    return sample;
  };
  EXPECT_LT(ticks_until_unknown(scene, 1000, in_its_own_frame), 250);
}

// A wrong twist keeps the object unknown; once it is right, six age limits have to agree.
TEST(Plausibility, ObjectIsUnknownWhileItsTwistLeadsElsewhere) {
  const Scene scene = balls_of_speed(2.0);
  Monitor monitor(scene);
  int found_out = 0, known_again = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    const double sign = tick < 1000 ? -1.0 : 1.0;
    const PoseSample sample = with_twist(test::at(-1e-3 * tick, 0, 0), Vec3(-sign, 0, 0), now);
    const PairStatus status = monitor.tick(std::span(&sample, 1), now).pairs[0].status;
    if (found_out == 0 && status == PairStatus::kUnknown) found_out = tick;
    if (found_out > 0 && tick < 1000) {
      ASSERT_EQ(status, PairStatus::kUnknown) << tick;
    }
    if (known_again == 0 && tick >= 1000 && status != PairStatus::kUnknown) known_again = tick;
  }
  EXPECT_GE(rejected(monitor, Reject::kOtherWay), 1u);
  EXPECT_NEAR(found_out, 22, 1);
  EXPECT_GT(known_again, 1000);
  EXPECT_LE(known_again, 1000 + 7 * 20);
}

TEST(Plausibility, ObjectThatMayJumpIsTakenAsItComes) {
  Scene scene = balls_of_speed(2.0);
  scene.objects[0].may_jump = true;
  Monitor monitor(scene);
  test::tick_with(monitor, 0, test::at(0, 0, 0), kStart);
  const Report& report = test::tick_with(monitor, 0, test::at(0.5, 0, 0), kStart + kTick);
  EXPECT_NEAR(report.pairs[0].distance, 0.3, 1e-9);
}

// Encoders repeat themselves at rest, and a measured speed is noise then.
TEST(Plausibility, ObjectAtRestIsNotFrozen) {
  for (const double speed : {0.25, 2.0}) {
    const Scene scene = balls_of_speed(speed);
    Monitor monitor(scene);
    Random random(6);
    for (int tick = 0; tick < 20'000; ++tick) {
      const std::int64_t now = kStart + tick * kTick;
      const PoseSample sample = with_twist(test::at(0, 0, 0), random.in_box(0.05), now);
      ASSERT_EQ(monitor.tick(std::span(&sample, 1), now).pairs[0].status, PairStatus::kConverged);
    }
  }
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
