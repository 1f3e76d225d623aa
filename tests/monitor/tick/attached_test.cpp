// Objects that are attached to links and to other objects.
//
// Oracles: a robot in whose description the attached body is a link behind a fixed joint; the
// closed form for balls.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "monitor/interface/gradient_rows.hpp"
#include "monitor/interface/zone_cause.hpp"
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

using Names = std::pair<std::string, std::string>;

Names names_of(const Scene& scene, const ObjectPair& pair) {
  const std::string &a = scene.objects[pair.first].name, &b = scene.objects[pair.second].name;
  return {std::min(a, b), std::max(a, b)};
}

std::map<Names, std::uint32_t> pairs_by_name(const Scene& scene) {
  std::map<Names, std::uint32_t> pairs;
  for (std::uint32_t i = 0; i < scene.pairs.size(); ++i) pairs[names_of(scene, scene.pairs[i])] = i;
  return pairs;
}

// The arm of scara_cell() with a box on its finger, and a ball on that box.
Scene attached_scene(const std::string& top = "") {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  return scene_of(
      "name: test\nunits: {length: m, angle: rad}\n" + top +
          "robots: [{name: arm, urdf: scara.urdf}]\nobjects:\n"
          "  - {name: ball, attached: {to: box, pose: {xyz: [0.2, 0, 0.1]}}, sphere: {radius: "
          "0.1}}\n"
          "  - {name: wall, fixed: true, half_space: {normal: [-1, 0, 0], offset: -5}}\n"
          "  - {name: box, attached: {to: finger, pose: {xyz: [0.1, 0.02, -0.03], rpy: [0.3, -0.2, "
          "1]}}, box: {size: [0.2, 0.1, 0.3]}}\n"
          "pairs:\n  - between: [arm, wall]\n  - between: [arm, arm]\n"
          "zones: [{name: near, between: [finger, wall], enter_below: 2.8, leave_above: 2.84}]\n",
      folder / "cell.yaml");
}

// The same bodies as links of the robot.
Scene linked_scene() {
  const test::ScratchFolder folder;
  std::string urdf = test::kScaraUrdf;
  urdf.insert(
      urdf.find("</robot>"),
      R"(<link name="box"><collision><geometry><box size="0.2 0.1 0.3"/></geometry></collision></link>
         <link name="ball"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
         <joint name="glue" type="fixed"><origin xyz="0.1 0.02 -0.03" rpy="0.3 -0.2 1"/><parent link="finger"/><child link="box"/></joint>
         <joint name="tape" type="fixed"><origin xyz="0.2 0 0.1"/><parent link="box"/><child link="ball"/></joint>)");
  test::write_text(folder / "scara.urdf", urdf);
  return scene_of(
      "name: test\nunits: {length: m, angle: rad}\n"
      "robots: [{name: arm, urdf: scara.urdf}]\nobjects:\n"
      "  - {name: wall, fixed: true, half_space: {normal: [-1, 0, 0], offset: -5}}\n"
      "pairs:\n  - between: [arm, wall]\n  - between: [arm, arm]\n"
      "allowed_collisions: [{between: [finger, ball], reason: rigid}]\n",
      folder / "cell.yaml");
}

TEST(AttachedObjects, ArePlacedAndBoundedAsLinksBehindFixedJoints) {
  const Scene attached = attached_scene(), linked = linked_scene();
  const auto by_name = pairs_by_name(attached), others = pairs_by_name(linked);
  Monitor monitor(attached), oracle(linked);
  int stale = 0, unknown = 0, known = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    const double t = 1e-3 * tick;
    std::vector<JointSample> samples;
    const std::array positions{std::sin(t), 1.3 * t, 0.1 + 0.1 * std::sin(2.0 * t)};
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
      const int phase = (tick / 100 + static_cast<int>(i)) % 7;
      if (tick < 50 && i == 2) continue;                   // not heard yet
      if (phase == 3) continue;                            // late
      const double leap = phase == 5 && tick % 100 == 50;  // contradicted
      samples.push_back(joint(i, positions[i] + leap, now));
    }
    monitor.tick({}, samples, now);
    oracle.tick({}, samples, now);
    for (const auto& [names, pair] : by_name) {
      ASSERT_TRUE(others.contains(names)) << names.first << " - " << names.second;
      const PairReport a = monitor.pair(pair), b = oracle.pair(others.at(names));
      ASSERT_EQ(a.status, b.status) << names.first << " - " << names.second << ", tick " << tick;
      stale += a.status == PairStatus::kStale;
      unknown += a.status == PairStatus::kUnknown;
      if (b.lower == -kInfinity) {
        ASSERT_EQ(a.lower, -kInfinity);
        continue;
      }
      ++known;
      ASSERT_NEAR(a.lower, b.lower, 1e-9) << names.first << " - " << names.second;
      ASSERT_NEAR(a.upper, b.upper, 1e-9);
      if (!std::isnan(b.closing_speed)) {
        ASSERT_NEAR(a.closing_speed, b.closing_speed, 1e-9);
      }
    }
  }
  EXPECT_EQ(by_name.size(), others.size());
  EXPECT_GT(stale, 100);
  EXPECT_GT(unknown, 100);
  EXPECT_GT(known, 1000);
}

TEST(AttachedObjects, CountInAZoneThatNamesTheirCarrier) {
  const Scene scene = attached_scene();
  Monitor monitor(scene);
  EXPECT_EQ(scene.zones[0].pairs.size(), 3u) << "finger, box and ball against the wall";
  const Report& report = monitor.tick({}, joints(0.0, 0.0, 0.1, kStart), kStart);
  EXPECT_TRUE(report.zones[0].active) << "the box and the ball are nearer than the finger";
  EXPECT_GT(test::report_between(scene, monitor, "finger", "wall").lower, 2.84);
}

TEST(AttachedObjects, GradientsOfTheirPairsAreThoseOfTheCarriersJoints) {
  const Scene scene = attached_scene("gradients: true\n"), linked = linked_scene();
  const auto by_name = pairs_by_name(scene), others = pairs_by_name(linked);
  for (const auto& [names, pair] : by_name) {
    const auto joints_of = [](const Scene& of, const ObjectPair& each) {
      std::multimap<std::string, bool> found;
      for (const MovingJoint& joint : joints_between(of, each))
        found.emplace(of.robots[joint.robot].joints[joint.joint].name, true);
      return found;
    };
    EXPECT_EQ(joints_of(scene, scene.pairs[pair]),
              joints_of(linked, linked.pairs[others.at(names)]))
        << names.first << " - " << names.second;
  }
  Monitor monitor(scene);
  const Report& report = monitor.tick({}, joints(0.2, 0.1, 0.1, kStart), kStart);
  for (const double rate : report.gradients.rates) EXPECT_TRUE(std::isfinite(rate));
  EXPECT_FALSE(report.gradients.rates.empty());
}

TEST(AttachedObjects, TakeNoPosesOfTheirOwn) {
  const Scene scene = attached_scene();
  Monitor monitor(scene);
  const auto box = static_cast<std::uint32_t>(
      std::ranges::find(scene.objects, "box", &Object::name) - scene.objects.begin());
  const std::array sent{test::sample(box, test::at(0, 0, 0), kStart)};
  const Report& report = monitor.tick(sent, {}, kStart);
  EXPECT_EQ(report.rejected[static_cast<std::size_t>(Reject::kOtherSource)], 1u);
  EXPECT_EQ(test::report_between(scene, monitor, "box", "wall").status, PairStatus::kUnknown);
}

TEST(AttachedObjects, ATickWithThemDoesNotAllocate) {
  const Scene scene = attached_scene("gradients: true\n");
  Monitor monitor(scene);
  monitor.tick({}, joints(0.0, 0.0, 0.1, kStart), kStart);
  const std::int64_t now = kStart + kTick;
  const auto samples = joints(0.01, 0.0, 0.1, now);
  const std::uint64_t before = allocations();
  monitor.tick({}, samples, now);
  EXPECT_EQ(allocations(), before);
}

// A tray on a cart, and a ball on the tray, beside a post at the origin.
Scene cart_scene(const std::string& speed) {
  return scene_of(
      "name: test\nunits: {length: m, angle: deg}\nobjects:\n"
      "  - {name: cart, groups: [moving], max_speed: 1, sphere: {radius: 0.1}}\n"
      "  - {name: post, fixed: true, sphere: {radius: 0.1}}\n"
      "  - {name: tray, attached: {to: cart, pose: {xyz: [0, 0, 1], rpy: [0, 0, 90]}}, sphere: "
      "{radius: 0.1}" +
      speed +
      "}\n"
      "  - {name: load, attached: {to: tray, pose: {xyz: [1, 0, 0]}}, sphere: {radius: 0.2}" +
      speed +
      "}\npairs: [{between: [moving, post]}]\n"
      "zones: [{name: near, between: [cart, post], enter_below: 1, leave_above: 2}]\n");
}

TEST(AttachedObjects, FollowAMovingObjectWithItsVelocityAndItsAge) {
  const Scene scene = cart_scene("");
  EXPECT_EQ(scene.pairs.size(), 3u) << "none within the rigid assembly";
  EXPECT_EQ(scene.zones[0].pairs.size(), 3u);
  Monitor monitor(scene);
  PoseSample sample = test::sample(0, test::at(3, 0, 0), kStart);
  sample.world_from_object.orientation =
      Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 2.0, Vec3::UnitZ()));
  sample.has_twist = true;
  sample.twist.angular = {0.0, 0.0, 0.5};
  sample.twist.linear = {-0.1, 0.0, 0.0};
  monitor.tick(std::array{sample}, kStart);
  // The cart's x axis points along y of the world, the tray's along -x: the load is at (2, 0, 1).
  const PairReport load = test::report_between(scene, monitor, "load", "post");
  EXPECT_EQ(load.status, PairStatus::kConverged);
  EXPECT_NEAR(load.distance, std::sqrt(5.0) - 0.3, 1e-12);
  EXPECT_LE(load.lower, std::sqrt(5.0) - 0.3);
  EXPECT_GE(load.upper, std::sqrt(5.0) - 0.3);
  // The centre moves by (-0.1, 0, 0) + (0, 0, 0.5) x (-1, 0, 1) = (-0.1, -0.5, 0).
  EXPECT_NEAR(load.closing_speed, 0.1 * 2.0 / std::sqrt(5.0), 1e-9);
}

// The largest speed of the cart's own points bounds nothing that is attached to it.
TEST(AttachedObjects, OnALateObjectAreUnknownUnlessTheyStateASpeed) {
  for (const bool is_stated : {false, true}) {
    const Scene scene = cart_scene(is_stated ? ", max_speed: 2" : "");
    Monitor monitor(scene);
    monitor.tick(std::array{test::sample(0, test::at(3, 0, 0), kStart)}, kStart);
    const double before = test::report_between(scene, monitor, "load", "post").lower;
    const Report& report = monitor.tick({}, kStart + 100 * kTick);
    EXPECT_NEAR(test::report_between(scene, monitor, "cart", "post").lower, 2.8 - 0.1, 1e-9);
    const PairReport load = test::report_between(scene, monitor, "load", "post");
    if (is_stated) {
      EXPECT_EQ(load.status, PairStatus::kStale);
      EXPECT_NEAR(load.lower, before - 0.2, 1e-9);
      EXPECT_LE(load.lower, before - 0.2 + 1e-12);
    } else {
      EXPECT_EQ(load.status, PairStatus::kUnknown);
      EXPECT_TRUE(report.zones[0].active);
    }
  }
}

TEST(AttachedObjects, TheCauseOfAZoneNamesWhatIsMissing) {
  const Scene cart = cart_scene("");
  const auto load = static_cast<std::uint32_t>(
      std::ranges::find(cart.objects, "load", &Object::name) - cart.objects.begin());
  EXPECT_EQ(carrying_object(cart, load), 0u);
  ZoneReport zone;
  zone.cause = ZoneCause::kLate;
  zone.cause_object = load;
  EXPECT_EQ(cause_text(cart, zone), cause_text(ZoneCause::kLate, "cart", PlacedBy::kPoses));
  const Scene arm = attached_scene();
  zone.cause_object = static_cast<std::uint32_t>(arm.objects.size() - 1);
  EXPECT_EQ(cause_text(arm, zone),
            cause_text(ZoneCause::kLate, arm.objects.back().name, PlacedBy::kJointStates));
}

TEST(AttachedObjects, OfAContradictedObjectAreUnknownWhateverTheirSpeed) {
  Scene scene = cart_scene(", max_speed: 2");
  Monitor monitor(scene);
  for (int tick = 0; tick < 20; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    const double x = tick % 2 == 0 ? 3.0 : 9.0;
    monitor.tick(std::array{test::sample(0, test::at(x, 0, 0), now)}, now);
  }
  EXPECT_EQ(test::report_between(scene, monitor, "cart", "post").status, PairStatus::kUnknown);
  EXPECT_EQ(test::report_between(scene, monitor, "load", "post").status, PairStatus::kUnknown);
}

TEST(AttachedObjects, OnAFixedObjectAreFixedOnes) {
  const Scene scene = scene_of(
      "name: test\nunits: {length: m, angle: deg}\nobjects:\n"
      "  - {name: ball, sphere: {radius: 0.1}}\n"
      "  - {name: load, attached: {to: table, pose: {xyz: [1, 0, 0]}}, sphere: {radius: 0.2}}\n"
      "  - {name: table, groups: [still], fixed: true, pose: {xyz: [0, 0, 1], rpy: [0, 0, 90]}, "
      "box: {size: [1, 1, 0.1]}}\n"
      "pairs: [{between: [still, ball]}]\n");
  Monitor monitor(scene);
  monitor.tick(std::array{test::sample(0, test::at(0, 3, 1), kStart)}, kStart);
  EXPECT_NEAR(test::report_between(scene, monitor, "load", "ball").distance, 2.0 - 0.3, 1e-12);
  EXPECT_TRUE(scene.robots.empty());
}

TEST(AbsentAtTheStart, AMovingObjectIsAbsentUntilItIsSaidToBeThere) {
  const Scene scene = scene_of(
      "name: test\nunits: {length: m, angle: deg}\nobjects:\n"
      "  - {name: cart, absent: true, sphere: {radius: 0.1}}\n"
      "  - {name: load, attached: {to: cart}, sphere: {radius: 0.2}}\n"
      "  - {name: other, sphere: {radius: 0.2}}\n"
      "pairs: [{between: [cart, other]}]\n"
      "zones: [{name: near, between: [cart, other], enter_below: 1, leave_above: 2}]\n");
  Monitor monitor(scene);
  const Report& report =
      monitor.tick(std::array{test::sample(1, test::at(0, 3, 1), kStart)}, kStart);
  EXPECT_EQ(absent_pairs(report), 2u);
  EXPECT_FALSE(report.zones[0].active);
  for (const std::uint32_t object : {0u, 2u}) {
    EXPECT_TRUE(monitor.input_age(object).absent);
    EXPECT_TRUE(monitor.set_absent(object, false));
  }
  const std::int64_t now = kStart + kTick;
  const std::array samples{test::sample(0, test::at(0, 0, 1), now),
                           test::sample(1, test::at(0, 3, 1), now)};
  EXPECT_EQ(absent_pairs(monitor.tick(samples, now)), 0u);
  EXPECT_NEAR(test::report_between(scene, monitor, "load", "other").distance, 3.0 - 0.4, 1e-12);
}

}  // namespace
}  // namespace clearance
