// Robots through the tick: joint states in, distances of their links out.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "monitor/kinematics/forward_kinematics.hpp"
#include "monitor/monitor.hpp"
#include "tests/config/cells.hpp"
#include "tests/monitor/small_cells.hpp"
#include "tests/shared/allocation_count.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

// Two links of a metre that swing about z, and a finger that slides out of the second.
const std::string kUrdf = R"(<robot name="scara">
  <link name="foot"><collision><origin xyz="0 0 -1"/><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
  <link name="finger"><collision><geometry><sphere radius="0.05"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><parent link="foot"/><child link="upper"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="2"/></joint>
  <joint name="elbow" type="continuous"><origin xyz="1 0 0"/><parent link="upper"/><child link="lower"/><axis xyz="0 0 1"/></joint>
  <joint name="push" type="prismatic"><origin xyz="1 0 0"/><parent link="lower"/><child link="finger"/><axis xyz="1 0 0"/><limit lower="0" upper="0.2" velocity="0.5"/></joint>
</robot>
)";

// Objects: wall, cart, foot, upper, lower, finger.
const std::string kRest =
    "objects:\n"
    "  - {name: wall, fixed: true, half_space: {normal: [-1, 0, 0], offset: -5}}\n"
    "  - {name: cart, may_jump: true, sphere: {radius: 0.1}}\n"
    "pairs:\n"
    "  - between: [arm, wall]\n"
    "  - between: [cart, wall]\n"
    "  - between: [arm, arm]\n"
    "zones:\n"
    "  - {name: near, between: [upper, wall], enter_below: 3.5, leave_above: 3.6}\n";

class RobotsInTheTick : public testing::Test {
 protected:
  RobotsInTheTick() { test::write_text(folder_ / "scara.urdf", kUrdf); }

  Scene scene(const std::string& base = "") {
    return scene_of(
        "name: test\nunits: {length: m, angle: rad}\nrobots: [{name: arm, urdf: "
        "scara.urdf" +
            base + "}]\n" + kRest,
        folder_ / "cell.yaml");
  }

  test::ScratchFolder folder_;
};

JointSample joint(std::uint32_t variable, double position, std::int64_t stamp_ns) {
  JointSample sample;
  sample.variable = variable;
  sample.position = position;
  sample.stamp_ns = stamp_ns;
  return sample;
}

std::array<JointSample, 3> joints(double shoulder, double elbow, double push, std::int64_t now) {
  return {joint(0, shoulder, now), joint(1, elbow, now), joint(2, push, now)};
}

PoseSample pose_of(std::uint32_t object, const LinkState& link, std::int64_t now) {
  PoseSample sample;
  sample.object = object;
  sample.stamp_ns = now;
  sample.world_from_object = link.pose;
  sample.twist = link.twist;
  sample.has_twist = true;
  return sample;
}

// The pair between these objects.
PairReport between(const Scene& scene, const Monitor& monitor, const std::string& a,
                   const std::string& b) {
  for (std::uint32_t pair = 0; pair < scene.pairs.size(); ++pair) {
    const std::string &first = scene.objects[scene.pairs[pair].first].name,
                      &second = scene.objects[scene.pairs[pair].second].name;
    if ((first == a && second == b) || (first == b && second == a)) return monitor.pair(pair);
  }
  ADD_FAILURE() << a << " - " << b << " is not watched";
  return {};
}

TEST_F(RobotsInTheTick, DistancesFollowTheJoints) {
  const Scene cell = scene();
  Monitor monitor(cell);
  monitor.tick({}, joints(0.0, 0.0, 0.1, kStart), kStart);
  EXPECT_NEAR(between(cell, monitor, "finger", "wall").distance, 5.0 - 2.1 - 0.05, 1e-12);
  const std::int64_t now = kStart + 600 * kTick;
  monitor.tick({}, joints(std::numbers::pi / 3.0, 0.0, 0.1, now), now);
  EXPECT_NEAR(between(cell, monitor, "finger", "wall").distance, 5.0 - 1.05 - 0.05, 1e-12);
  EXPECT_NEAR(between(cell, monitor, "upper", "wall").distance,
              5.0 - 0.45 - 0.05 * std::sin(std::numbers::pi / 3.0), 1e-12);
}

TEST_F(RobotsInTheTick, ClosingSpeedsComeFromJointVelocities) {
  const Scene cell = scene();
  Monitor monitor(cell);
  auto samples = joints(0.0, 0.0, 0.1, kStart);
  for (JointSample& sample : samples) sample.has_velocity = true;
  samples[0].velocity = 1.0;
  samples[2].velocity = 0.3;
  monitor.tick({}, samples, kStart);
  EXPECT_NEAR(between(cell, monitor, "finger", "wall").closing_speed, 0.3, 1e-12);
}

TEST_F(RobotsInTheTick, JointStatesAndLinkPosesOfOneMotionGiveTheSameDistances) {
  const Scene cell = scene();
  Monitor by_joints(cell), by_poses(cell);
  ForwardKinematics kinematics(cell.robots);
  for (int tick = 0; tick < 1000; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    const double t = 1e-3 * tick;
    auto samples = joints(std::sin(1.3 * t), 2.0 * std::cos(t), 0.1 + 0.1 * std::sin(2.0 * t), now);
    const std::array rates{1.3 * std::cos(1.3 * t), -2.0 * std::sin(t), 0.2 * std::cos(2.0 * t)};
    std::array<TrackedVariable, 3> states;
    for (std::size_t i = 0; i < 3; ++i) {
      samples[i].has_velocity = states[i].velocity_known = states[i].seen = true;
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

TEST_F(RobotsInTheTick, OnlyWhatHangsOnAnUnknownJointIsUnknown) {
  const Scene cell = scene();
  Monitor monitor(cell);
  const std::array some{joint(0, 0.0, kStart), joint(2, 0.1, kStart)};
  const Report& report = monitor.tick({}, some, kStart);
  EXPECT_EQ(between(cell, monitor, "upper", "wall").status, PairStatus::kConverged);
  EXPECT_EQ(between(cell, monitor, "lower", "wall").status, PairStatus::kUnknown);
  EXPECT_EQ(between(cell, monitor, "finger", "wall").status, PairStatus::kUnknown);
  EXPECT_FALSE(report.minimum_certified);
}

TEST_F(RobotsInTheTick, AZoneOfLinksIsActiveUntilTheirJointsAreKnown) {
  const Scene cell = scene();
  Monitor monitor(cell);
  EXPECT_TRUE(monitor.tick({}, {}, kStart).zones[0].active);
  EXPECT_EQ(monitor.tick({}, {}, kStart).zones[0].cause, ZoneCause::kUnknown);
  const std::int64_t now = kStart + kTick;
  EXPECT_FALSE(monitor.tick({}, joints(0.0, 0.0, 0.0, now), now).zones[0].active);
}

// Each joint by its own limits: the shoulder turns 2 rad/s, the elbow anyhow, but only about
// itself.
TEST_F(RobotsInTheTick, LateJointsWidenTheBoundsOfWhatTheyCarry) {
  const Scene cell = scene();
  Monitor monitor(cell);
  monitor.tick({}, joints(0.0, 0.0, 0.1, kStart), kStart);
  const std::int64_t now = kStart + 50 * kTick;
  const std::array fresh{joint(1, 0.0, now), joint(2, 0.1, now)};
  monitor.tick({}, fresh, now);
  const PairReport upper = between(cell, monitor, "upper", "wall");
  EXPECT_EQ(upper.status, PairStatus::kStale);
  const double reach = std::hypot(0.9, 0.05, 0.05);
  EXPECT_NEAR(upper.lower, 5.0 - 0.9 - 0.1 * reach, 2e-3);
  EXPECT_LE(upper.lower, 5.0 - 0.9 - 0.1 * reach + 1e-12);
  // Out to the finger, which is 2.1 m from the shoulder, and 0.05 m in radius.
  const PairReport finger = between(cell, monitor, "finger", "wall");
  EXPECT_NEAR(finger.lower, 5.0 - 2.15 - 0.1 * 2.15, 1e-9);
  EXPECT_TRUE(std::isnan(finger.closing_speed));

  const std::int64_t later = now + 50 * kTick;
  const std::array without_elbow{joint(0, 0.0, later), joint(2, 0.1, later)};
  monitor.tick({}, without_elbow, later);
  EXPECT_EQ(between(cell, monitor, "upper", "wall").status, PairStatus::kConverged);
  EXPECT_NEAR(between(cell, monitor, "finger", "wall").lower, 5.0 - 2.15 - 2.0 * 1.15, 1e-9);
}

TEST_F(RobotsInTheTick, APublisherOfZerosThatWasLeftRunningIsRefused) {
  const Scene cell = scene();
  Monitor monitor(cell);
  for (int tick = 0; tick < 100; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    auto samples = joints(1.0, 0.5, 0.1, now);
    std::vector<JointSample> all(samples.begin(), samples.end());
    for (JointSample& zero : samples) {
      zero.position = 0.0;
      zero.source = 1;
      all.push_back(zero);
    }
    const Report& report = monitor.tick({}, all, now);
    ASSERT_EQ(report.rejected[static_cast<std::size_t>(Reject::kOtherSource)], 3u * (tick + 1));
    ASSERT_NEAR(between(cell, monitor, "upper", "wall").distance,
                5.0 - 0.9 * std::cos(1.0) - 0.05 * std::sin(1.0), 1e-12);
  }
}

TEST_F(RobotsInTheTick, PosesOfLinksAreTakenUntilJointsAreHeard) {
  const Scene cell = scene();
  Monitor monitor(cell);
  LinkState link;
  link.pose.position = Vec3(1.0, 0.0, 0.0);
  const std::array pose{pose_of(3, link, kStart)};
  monitor.tick(pose, kStart);
  EXPECT_NEAR(between(cell, monitor, "upper", "wall").distance, 5.0 - 1.9, 1e-12);
  monitor.tick(pose, joints(0.0, 0.0, 0.1, kStart), kStart + kTick);
  EXPECT_NEAR(between(cell, monitor, "upper", "wall").distance, 5.0 - 0.9, 1e-12);
  EXPECT_EQ(monitor.rejected(3)[static_cast<std::size_t>(Reject::kOtherSource)], 1u);
}

TEST_F(RobotsInTheTick, ARobotMovesWithWhatItStandsOn) {
  const Scene cell = scene(", base: {on: cart}");
  Monitor monitor(cell);
  const auto still = [](std::int64_t now) { return joints(0.0, 0.0, 0.1, now); };
  monitor.tick({}, still(kStart), kStart);
  EXPECT_EQ(between(cell, monitor, "finger", "wall").status, PairStatus::kUnknown);
  LinkState cart;
  cart.pose.position = Vec3(1.5, 0.0, 0.0);
  const std::array pose{pose_of(1, cart, kStart + kTick)};
  monitor.tick(pose, still(kStart + kTick), kStart + kTick);
  EXPECT_NEAR(between(cell, monitor, "finger", "wall").distance, 5.0 - 1.5 - 2.15, 1e-12);
  const std::int64_t later = kStart + 100 * kTick;
  monitor.tick({}, still(later), later);
  EXPECT_EQ(between(cell, monitor, "finger", "wall").status, PairStatus::kUnknown);
}

TEST_F(RobotsInTheTick, StampsAreThoseOfTheSourcesClock) {
  const Scene cell = scene();
  Monitor monitor(cell);
  constexpr std::int64_t kOffset = 3'600'000'000'000;
  monitor.tick({}, joints(0.0, 0.0, 0.1, kStart + kOffset), {kStart, kOffset});
  EXPECT_EQ(between(cell, monitor, "finger", "wall").age_b_ns +
                between(cell, monitor, "finger", "wall").age_a_ns,
            0);
  // A tick that is told less than the one before knows no ages.
  monitor.tick({}, {}, {kStart - kTick, kOffset});
  EXPECT_EQ(between(cell, monitor, "upper", "wall").status, PairStatus::kStale);
}

TEST_F(RobotsInTheTick, UnknownVariablesAreCountedAndNothingIsAllocated) {
  const Scene cell = scene();
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
