// The effects of poses on a tick: unknown, late, refused and repeated ones, and the speeds that
// they imply.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "monitor/tick/monitor.hpp"
#include "tests/monitor/tick/two_balls.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;
using test::tick_with;
using test::two_balls;

TEST(MonitorInputs, TimeToContactFollowsFromFiniteDifferencesOfPoses) {
  const Scene scene = two_balls();
  Monitor monitor(scene);
  tick_with(monitor, 0, test::at(0.400, 0, 0), kStart);
  const Report& report = tick_with(monitor, 0, test::at(0.401, 0, 0), kStart + kTick);
  EXPECT_NEAR(report.minimum.closing_speed, 1.0, 1e-9);
  EXPECT_NEAR(report.minimum.time_to_contact, 0.399, 1e-9);
}

TEST(MonitorInputs, ClosingSpeedIsUnknownWhileAVelocityIs) {
  Scene scene = two_balls();
  scene.objects[0].max_speed = 2.0;
  Monitor monitor(scene);
  const auto unknown = [](const Report& report) {
    EXPECT_TRUE(report.minimum_known);
    EXPECT_EQ(std::isnan(report.minimum.closing_speed), std::isnan(report.minimum.time_to_contact));
    EXPECT_EQ(std::isnan(report.minimum.closing_speed), std::isnan(report.pairs[0].closing_speed));
    return std::isnan(report.minimum.closing_speed);
  };
  EXPECT_TRUE(unknown(tick_with(monitor, 0, test::at(0, 0, 0), kStart)));
  EXPECT_TRUE(unknown(monitor.tick({}, kStart + kTick)));
  EXPECT_FALSE(unknown(tick_with(monitor, 0, test::at(0, 0, 0), kStart + 2 * kTick)));
  EXPECT_TRUE(unknown(monitor.tick({}, kStart + 50 * kTick))) << "the pose is late";
  EXPECT_TRUE(unknown(tick_with(monitor, 0, test::at(0.1, 0, 0), kStart + 60 * kTick)))
      << "what it did in the gap says nothing";
  EXPECT_FALSE(unknown(tick_with(monitor, 0, test::at(0.1, 0, 0), kStart + 61 * kTick)));
}

TEST(MonitorInputs, VelocitySentWithTheFirstPoseIsKnownAtOnce) {
  const Scene scene = two_balls();
  Monitor monitor(scene);
  PoseSample sample = test::sample(0, test::at(0, 0, 0), kStart);
  sample.has_twist = true;
  sample.twist.linear = Vec3(2, 0, 0);
  const Report& report = monitor.tick(std::span(&sample, 1), kStart);
  EXPECT_NEAR(report.minimum.closing_speed, 2.0, 1e-12);
  EXPECT_NEAR(report.minimum.time_to_contact, 0.4, 1e-12);
}

TEST(MonitorInputs, NothingIsKnownBeforeTheFirstPose) {
  const Scene scene = two_balls();
  Monitor monitor(scene);
  const Report& report = monitor.tick({}, kStart);
  EXPECT_FALSE(report.minimum_known);
  EXPECT_FALSE(report.minimum_certified);
  EXPECT_EQ(report.unknown, 1u);
  EXPECT_EQ(report.queries, 0u);
  EXPECT_EQ(report.lower_all, -kInfinity);
  for (const PairReport& pair : {report.pairs.at(0), report.minimum}) {
    EXPECT_EQ(pair.status, PairStatus::kUnknown);
    EXPECT_TRUE(std::isnan(pair.distance));
    EXPECT_TRUE(std::isnan(pair.closing_speed));
    EXPECT_TRUE(std::isnan(pair.time_to_contact));
    EXPECT_TRUE(pair.witness_a.array().isNaN().all());
    EXPECT_TRUE(pair.normal.array().isNaN().all());
    EXPECT_EQ(pair.lower, -kInfinity);
    EXPECT_EQ(pair.upper, kInfinity);
  }
  EXPECT_EQ(report.pairs.at(0).age_a_ns, -1);
  EXPECT_EQ(report.pairs.at(0).age_b_ns, 0);
  EXPECT_EQ(monitor.input_age(0).age_ns, -1);
}

TEST(MonitorInputs, LatePosesDecayTheBoundsByTheStatedSpeedAndSaySo) {
  Scene scene = two_balls();
  scene.objects[0].max_speed = 2.0;
  Monitor monitor(scene);
  tick_with(monitor, 0, test::at(0, 0, 0), kStart);
  const Report& in_time = monitor.tick({}, kStart + 20 * kTick);
  EXPECT_EQ(in_time.stale, 0u);
  EXPECT_NEAR(in_time.pairs[0].lower, 0.8, 1e-12);

  const Report& late = monitor.tick({}, kStart + 100 * kTick);
  EXPECT_EQ(late.stale, 1u);
  EXPECT_EQ(late.evaluated + late.carried + late.unknown, 0u);
  EXPECT_EQ(late.pairs[0].status, PairStatus::kStale);
  EXPECT_EQ(late.pairs[0].age_a_ns, 100 * kTick);
  EXPECT_NEAR(late.pairs[0].distance, 0.8, 1e-12);
  EXPECT_NEAR(late.pairs[0].lower, 0.6, 1e-12);
  EXPECT_LE(late.pairs[0].lower, 0.6);
  EXPECT_NEAR(late.pairs[0].upper, 1.0, 1e-12);
  EXPECT_TRUE(late.minimum_known);
  EXPECT_FALSE(late.minimum_certified);
  EXPECT_TRUE(monitor.input_age(0).stale);

  const Report& back = tick_with(monitor, 0, test::at(0.1, 0, 0), kStart + 101 * kTick);
  EXPECT_EQ(back.stale, 0u);
  EXPECT_NEAR(back.pairs[0].lower, 0.7, 1e-12);
  EXPECT_FALSE(monitor.input_age(0).stale);
}

TEST(MonitorInputs, LatePosesWithoutAStatedSpeedAreUnknownUntilTheNextPose) {
  const Scene scene = two_balls();
  Monitor monitor(scene);
  tick_with(monitor, 0, test::at(0, 0, 0), kStart);
  const Report& late = monitor.tick({}, kStart + 21 * kTick);
  EXPECT_EQ(late.unknown, 1u);
  EXPECT_FALSE(late.minimum_known);
  EXPECT_EQ(late.lower_all, -kInfinity);
  EXPECT_TRUE(std::isnan(late.pairs[0].distance));
  EXPECT_EQ(late.pairs[0].age_a_ns, 21 * kTick);
  const Report& back = tick_with(monitor, 0, test::at(0.1, 0, 0), kStart + 22 * kTick);
  EXPECT_TRUE(back.minimum_certified);
}

// Oracle: all positions that the object can have reached at its speed.
TEST(MonitorInputs, StaleBoundsHoldWhereverTheObjectWentSince) {
  Random random(52);
  Scene scene = test::cell_of({test::moving("a", {test::capsule(1.0, 0.02)}),
                               test::moving("b", {test::capsule(0.5, 0.02)})});
  scene.objects[0].max_speed = 1.5;
  scene.objects[1].max_speed = 1.0;
  for (int i = 0; i < 200; ++i) {
    Monitor monitor(scene);
    Pose a = random.pose(1.5);
    const Pose b = random.pose(1.5);
    const std::array samples{test::sample(0, a, kStart), test::sample(1, b, kStart)};
    monitor.tick(samples, kStart);
    const PoseSample b_again = test::sample(1, b, kStart + 50 * kTick);
    monitor.tick(std::span(&b_again, 1), kStart + 50 * kTick);
    a.position += 0.05 * 1.5 * random.in_box(1.0).normalized();
    const long double truth = test::true_distance(scene.objects[0], a, scene.objects[1], b);
    const PairReport pair = monitor.pair(0);
    ASSERT_EQ(pair.status, PairStatus::kStale);
    ASSERT_LE(pair.lower, truth);
    ASSERT_GE(pair.upper, truth);
  }
}

TEST(MonitorInputs, RefusedSamplesAreCountedByCauseAndNeverUsed) {
  const Scene scene = two_balls();
  Monitor monitor(scene);
  const Pose good = test::at(0, 0, 0);
  tick_with(monitor, 0, good, kStart);
  Pose nowhere = good, stretched = good;
  nowhere.position.x() = std::numeric_limits<double>::quiet_NaN();
  stretched.orientation.coeffs() *= 1.1;
  const std::array samples{
      test::sample(0, nowhere, kStart),
      test::sample(0, stretched, kStart),
      test::sample(0, stretched, kStart),
      test::sample(0, test::at(0.5, 0, 0), kStart - 1),
      test::sample(0, test::at(0.5, 0, 0), kStart + 100 * kTick),
      test::sample(1, test::at(0.5, 0, 0), kStart),   // a fixed object
      test::sample(99, test::at(0.5, 0, 0), kStart),  // no such object
  };
  const Report& report = monitor.tick(samples, kStart + kTick);
  EXPECT_EQ(monitor.rejected(0), (std::array<std::uint64_t, kRejects>{0, 1, 2, 1, 1}));
  EXPECT_EQ(monitor.rejected(1), (std::array<std::uint64_t, kRejects>{1}));
  EXPECT_EQ(report.rejected, (std::array<std::uint64_t, kRejects>{2, 1, 2, 1, 1}));
  EXPECT_EQ(report.newest_pose_ns, kStart);
  EXPECT_EQ(report.unknown, 1u) << "its source dates poses ahead";
  const Report& later = tick_with(monitor, 0, good, kStart + 22 * kTick);
  EXPECT_NEAR(later.minimum.distance, 0.8, 1e-12);

  monitor.refuse(0, Reject::kWrongRevision);
  monitor.refuse(99, Reject::kWrongRevision);
  EXPECT_EQ(monitor.rejected(0)[static_cast<std::size_t>(Reject::kWrongRevision)], 1u);
  const Report& next = monitor.tick({}, kStart + 23 * kTick);
  EXPECT_EQ(next.rejected[static_cast<std::size_t>(Reject::kWrongRevision)], 2u);
}

// The elapsed time is unknown.
TEST(MonitorInputs, AfterATimeThatGoesBackwardsEveryPoseIsLateUntilTheNextOne) {
  const Scene scene = two_balls();
  Monitor monitor(scene);
  tick_with(monitor, 0, test::at(0, 0, 0), kStart);
  const Report& report = monitor.tick({}, kStart - 100 * kTick);
  EXPECT_EQ(report.now_ns, kStart - 100 * kTick);
  EXPECT_EQ(report.pairs[0].status, PairStatus::kUnknown);
  const Report& next = tick_with(monitor, 0, test::at(0.1, 0, 0), kStart - 99 * kTick);
  EXPECT_EQ(next.pairs[0].status, PairStatus::kConverged);
  EXPECT_NEAR(next.minimum.distance, 0.7, 1e-12);
}

// This machine's clock was stepped meanwhile. A stamp of the next pose is by the new clock from the
// first one on.
TEST(MonitorInputs, AfterATimeThatGoesBackwardsEverySourceIsByThisMachinesClock) {
  const Scene scene = two_balls();
  Monitor monitor(scene);
  tick_with(monitor, 0, test::at(0, 0, 0), kStart);
  constexpr std::int64_t kStepped = 1000 * kTick;
  const TickTime before(kStart - 100 * kTick, kStepped);
  const PoseSample sample = test::sample(0, test::at(0.1, 0, 0), before.now_ns + kStepped);
  const Report& report = monitor.tick(std::span(&sample, 1), {}, before);
  EXPECT_EQ(report.rejected, (std::array<std::uint64_t, kRejects>{}));
  EXPECT_EQ(report.pairs[0].age_a_ns, 0);
  EXPECT_NEAR(report.minimum.distance, 0.7, 1e-12);
}

TEST(MonitorInputs, TheLastOfSeveralSamplesOfATickIsUsed) {
  const Scene scene = two_balls();
  Monitor monitor(scene);
  const std::array samples{test::sample(0, test::at(0.3, 0, 0), kStart),
                           test::sample(0, test::at(0.1, 0, 0), kStart + 1),
                           test::sample(0, test::at(0.2, 0, 0), kStart)};
  EXPECT_NEAR(monitor.tick(samples, kStart).minimum.distance, 0.7, 1e-12);
}

}  // namespace
}  // namespace clearance
