// Robots in the tick: joint states are the input, distances of their links the output.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "monitor/bodies/forward_kinematics.hpp"
#include "monitor/inputs/source_numbers.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance {
namespace {

using test::joint;
using test::joints;
using test::kStart;
using test::kTick;

PoseSample pose_of(std::uint32_t object, const LinkState& link, std::int64_t now) {
  PoseSample sample;
  sample.object = object;
  sample.stamp_ns = now;
  sample.world_from_object = link.pose;
  sample.twist = link.twist;
  sample.has_twist = true;
  return sample;
}

TEST(RobotsInTheTick, DistancesFollowTheJoints) {
  const Scene cell = test::scara_cell();
  Monitor monitor(cell);
  monitor.tick({}, joints(0.0, 0.0, 0.1, kStart), kStart);
  EXPECT_NEAR(test::report_between(cell, monitor, "finger", "wall").distance, 5.0 - 2.1 - 0.05,
              1e-12);
  const std::int64_t now = kStart + 600 * kTick;
  monitor.tick({}, joints(std::numbers::pi / 3.0, 0.0, 0.1, now), now);
  EXPECT_NEAR(test::report_between(cell, monitor, "finger", "wall").distance, 5.0 - 1.05 - 0.05,
              1e-12);
  EXPECT_NEAR(test::report_between(cell, monitor, "upper", "wall").distance,
              5.0 - 0.45 - 0.05 * std::sin(std::numbers::pi / 3.0), 1e-12);
}

// Wheels turn far, and a base may be kilometres away. The queried shapes are enlarged by the
// rounding error.
TEST(RobotsInTheTick, BoundsAccountForTheRoundingOfTheChain) {
  const Scene scene = test::scara_cell(", base: {on: cart}");
  ForwardKinematics kinematics(scene.robots);
  std::vector<TrackedVariable> variables(scene.variables.size());
  std::vector<LinkState> bases(1);
  bases[0].known = true;
  bases[0].pose = test::at(6000.0, -5000.0, 5000.0);
  for (const double angle : {0.1, 3.0, -999'000.0}) {
    for (TrackedVariable& variable : variables) {
      variable.input.has_value = true;
      variable.position = angle;
    }
    variables[2].position = 0.2;
    kinematics.place(variables, bases);
    for (const RobotLink& link : scene.robots[0].links) {
      const Object& object = scene.objects[link.object];
      const auto index = static_cast<std::size_t>(&link - scene.robots[0].links.data());
      const Part& part = object.parts[0];
      const double reach =
          part.object_from_part.position.norm() + part.shape.bounding_radius + part.shape.radius;
      EXPECT_LE(kinematics.links(0)[index].error(reach), object.pose_error) << object.name;
      EXPECT_GE(part.shape.position_error, object.pose_error);
      EXPECT_GE(part.shape.error_bound_as_a, object.pose_error);
      EXPECT_LT(object.pose_error, 1e-9) << object.name;
    }
  }
}

TEST(RobotsInTheTick, ClosingSpeedsComeFromJointVelocities) {
  const Scene cell = test::scara_cell();
  Monitor monitor(cell);
  auto samples = joints(0.0, 0.0, 0.1, kStart);
  for (JointSample& sample : samples) sample.has_velocity = true;
  samples[0].velocity = 1.0;
  samples[2].velocity = 0.3;
  monitor.tick({}, samples, kStart);
  EXPECT_NEAR(test::report_between(cell, monitor, "finger", "wall").closing_speed, 0.3, 1e-12);
}

TEST(RobotsInTheTick, JointStatesAndLinkPosesOfOneMotionGiveTheSameDistances) {
  const Scene cell = test::scara_cell();
  Monitor by_joints(cell), by_poses(cell);
  ForwardKinematics kinematics(cell.robots);
  for (int tick = 0; tick < 1000; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    const double t = 1e-3 * tick;
    auto samples = joints(std::sin(1.3 * t), 2.0 * std::cos(t), 0.1 + 0.1 * std::sin(2.0 * t), now);
    const std::array rates{1.3 * std::cos(1.3 * t), -2.0 * std::sin(t), 0.2 * std::cos(2.0 * t)};
    std::array<TrackedVariable, 3> states;
    for (std::size_t i = 0; i < 3; ++i) {
      samples[i].has_velocity = states[i].velocity_known = states[i].input.has_value = true;
      samples[i].velocity = states[i].velocity = rates[i];
      states[i].position = samples[i].position;
    }
    kinematics.place(states, {});
    const auto links = kinematics.links(0);
    const std::array poses{pose_of(3, links[1], now), pose_of(4, links[2], now),
                           pose_of(5, links[3], now)};
    by_joints.tick({}, samples, now);
    by_poses.tick(poses, now);
    for (std::uint32_t pair = 0; pair < cell.pairs.size(); ++pair) {
      const PairReport a = by_joints.pair(pair), b = by_poses.pair(pair);
      ASSERT_EQ(a.status, b.status);
      if (a.status == PairStatus::kUnknown) continue;
      ASSERT_NEAR(a.distance, b.distance, 1e-12);
      ASSERT_NEAR(a.lower, b.lower, 1e-12);
      ASSERT_NEAR(a.closing_speed, b.closing_speed, 1e-9);
    }
  }
}

TEST(RobotsInTheTick, OnlyWhatHangsOnAnUnknownJointIsUnknown) {
  const Scene cell = test::scara_cell();
  Monitor monitor(cell);
  const std::array some{joint(0, 0.0, kStart), joint(2, 0.1, kStart)};
  const Report& report = monitor.tick({}, some, kStart);
  EXPECT_EQ(test::report_between(cell, monitor, "upper", "wall").status, PairStatus::kConverged);
  EXPECT_EQ(test::report_between(cell, monitor, "lower", "wall").status, PairStatus::kUnknown);
  EXPECT_EQ(test::report_between(cell, monitor, "finger", "wall").status, PairStatus::kUnknown);
  EXPECT_FALSE(report.minimum_certified);
}

TEST(RobotsInTheTick, AZoneOfLinksIsActiveUntilTheirJointsAreKnown) {
  const Scene cell = test::scara_cell();
  Monitor monitor(cell);
  EXPECT_TRUE(monitor.tick({}, {}, kStart).zones[0].active);
  EXPECT_EQ(monitor.tick({}, {}, kStart).zones[0].cause, ZoneCause::kUnknown);
  const std::int64_t now = kStart + kTick;
  EXPECT_FALSE(monitor.tick({}, joints(0.0, 0.0, 0.0, now), now).zones[0].active);
}

// Each joint moves within its own limits: the shoulder at 2 rad/s; the elbow at any speed, but only
// about its axis.
TEST(RobotsInTheTick, LateJointsWidenTheBoundsOfWhatTheyCarry) {
  const Scene cell = test::scara_cell();
  Monitor monitor(cell);
  monitor.tick({}, joints(0.0, 0.0, 0.1, kStart), kStart);
  const std::int64_t now = kStart + 50 * kTick;
  const std::array fresh{joint(1, 0.0, now), joint(2, 0.1, now)};
  monitor.tick({}, fresh, now);
  const PairReport upper = test::report_between(cell, monitor, "upper", "wall");
  EXPECT_EQ(upper.status, PairStatus::kStale);
  const double reach = std::hypot(0.9, 0.05, 0.05);
  EXPECT_NEAR(upper.lower, 5.0 - 0.9 - 0.1 * reach, 2e-3);
  EXPECT_LE(upper.lower, 5.0 - 0.9 - 0.1 * reach + 1e-12);
  // The bound extends to the finger, which is 2.1 m from the shoulder and has a radius of 0.05 m.
  const PairReport finger = test::report_between(cell, monitor, "finger", "wall");
  EXPECT_NEAR(finger.lower, 5.0 - 2.15 - 0.1 * 2.15, 1e-9);
  EXPECT_TRUE(std::isnan(finger.closing_speed));

  const std::int64_t later = now + 50 * kTick;
  const std::array without_elbow{joint(0, 0.0, later), joint(2, 0.1, later)};
  monitor.tick({}, without_elbow, later);
  EXPECT_EQ(test::report_between(cell, monitor, "upper", "wall").status, PairStatus::kConverged);
  EXPECT_NEAR(test::report_between(cell, monitor, "finger", "wall").lower, 5.0 - 2.15 - 2.0 * 1.15,
              1e-9);
}

// Nothing tells which of the two is the driver, unless the cell says so.
TEST(RobotsInTheTick, APublisherOfZerosThatWasLeftRunningMakesTheRobotUnknown) {
  for (const bool is_stated : {false, true}) {
    Scene cell = test::scara_cell();
    if (is_stated) {
      for (JointVariable& variable : cell.variables) variable.source = "driver";
    }
    SourceNumbers numbers(cell);
    const std::uint32_t driver = numbers.of(SourceName("driver")),
                        zeros = numbers.of(SourceName("zeros"));
    Monitor monitor(cell);
    for (int tick = 0; tick < 100; ++tick) {
      const std::int64_t now = kStart + tick * kTick;
      std::vector<JointSample> all;
      for (JointSample sample : joints(0.0, 0.0, 0.0, now)) {
        sample.source = zeros;
        all.push_back(sample);
      }
      for (JointSample sample : joints(1.0, 0.5, 0.1, now)) {
        sample.source = driver;
        all.push_back(sample);
      }
      monitor.tick({}, all, now);
      const PairReport pair = test::report_between(cell, monitor, "upper", "wall");
      if (is_stated) {
        ASSERT_NEAR(pair.distance, 5.0 - 0.9 * std::cos(1.0) - 0.05 * std::sin(1.0), 1e-12);
      } else {
        ASSERT_NE(pair.status, PairStatus::kConverged) << tick;
        ASSERT_LE(pair.lower, 5.0 - 0.9 * std::cos(1.0) - 0.05 * std::sin(1.0));
      }
    }
  }
}

TEST(RobotsInTheTick, PosesOfLinksAreTakenUntilJointsAreHeard) {
  const Scene cell = test::scara_cell();
  Monitor monitor(cell);
  LinkState link;
  link.pose.position = Vec3(1.0, 0.0, 0.0);
  const std::array pose{pose_of(3, link, kStart)};
  monitor.tick(pose, kStart);
  EXPECT_NEAR(test::report_between(cell, monitor, "upper", "wall").distance, 5.0 - 1.9, 1e-12);
  monitor.tick(pose, joints(0.0, 0.0, 0.1, kStart), kStart + kTick);
  EXPECT_NEAR(test::report_between(cell, monitor, "upper", "wall").distance, 5.0 - 0.9, 1e-12);
  EXPECT_EQ(monitor.rejected(3)[static_cast<std::size_t>(Reject::kOtherSource)], 1u);
}

// A sample that repeats the pose of an object at rest is taken without most checks.
TEST(RobotsInTheTick, PosesOfALinkAtRestAreRefusedFromTheTickOfItsFirstJointsOn) {
  const Scene cell = test::scara_cell();
  Monitor monitor(cell);
  LinkState link;
  link.pose.position = Vec3(1.0, 0.0, 0.0);
  std::int64_t now = kStart;
  for (int tick = 0; tick < 5; ++tick, now += kTick) {
    std::array pose{pose_of(3, link, now)};
    pose[0].has_twist = true;
    monitor.tick(pose, now);
  }
  const auto refused = [&] {
    return monitor.rejected(3)[static_cast<std::size_t>(Reject::kOtherSource)];
  };
  ASSERT_EQ(refused(), 0u);
  std::array pose{pose_of(3, link, now)};
  pose[0].has_twist = true;
  monitor.tick(pose, joints(0.0, 0.0, 0.1, now), now);
  EXPECT_EQ(refused(), 1u);
  EXPECT_NEAR(test::report_between(cell, monitor, "upper", "wall").distance, 5.0 - 0.9, 1e-12);
}

TEST(RobotsInTheTick, ARobotMovesWithWhatItStandsOn) {
  const Scene cell = test::scara_cell(", base: {on: cart}");
  Monitor monitor(cell);
  const auto still = [](std::int64_t now) { return joints(0.0, 0.0, 0.1, now); };
  monitor.tick({}, still(kStart), kStart);
  EXPECT_EQ(test::report_between(cell, monitor, "finger", "wall").status, PairStatus::kUnknown);
  LinkState cart;
  cart.pose.position = Vec3(1.5, 0.0, 0.0);
  const std::array pose{pose_of(1, cart, kStart + kTick)};
  monitor.tick(pose, still(kStart + kTick), kStart + kTick);
  EXPECT_NEAR(test::report_between(cell, monitor, "finger", "wall").distance, 5.0 - 1.5 - 2.15,
              1e-12);
  const std::int64_t later = kStart + 100 * kTick;
  monitor.tick({}, still(later), later);
  EXPECT_EQ(test::report_between(cell, monitor, "finger", "wall").status, PairStatus::kUnknown);
}

TEST(RobotsInTheTick, StampsAreThoseOfTheSourcesClock) {
  const Scene cell = test::scara_cell();
  Monitor monitor(cell);
  constexpr std::int64_t kOffset = 3'600'000'000'000;
  monitor.tick({}, joints(0.0, 0.0, 0.1, kStart + kOffset), {kStart, kOffset});
  EXPECT_EQ(test::report_between(cell, monitor, "finger", "wall").age_b_ns +
                test::report_between(cell, monitor, "finger", "wall").age_a_ns,
            0);
  // In a tick whose time is before that of the previous tick, ages are unknown.
  monitor.tick({}, {}, {kStart - kTick, kOffset});
  EXPECT_EQ(test::report_between(cell, monitor, "upper", "wall").status, PairStatus::kStale);
}

TEST(RobotsInTheTick, UnknownVariablesAreCountedAndNothingIsAllocated) {
  const Scene cell = test::scara_cell();
  Monitor monitor(cell);
  monitor.tick({}, joints(0.0, 0.0, 0.1, kStart), kStart);
  const auto samples = joints(0.01, 0.01, 0.1, kStart + kTick);
  const std::array bad{joint(99, 0.0, kStart + kTick)};
  const std::uint64_t before = allocations();
  monitor.tick({}, samples, kStart + kTick);
  const Report& report = monitor.tick({}, bad, kStart + 2 * kTick);
  EXPECT_EQ(allocations(), before);
  EXPECT_EQ(report.rejected[static_cast<std::size_t>(Reject::kUnknownObject)], 1u);
}

}  // namespace
}  // namespace clearance
