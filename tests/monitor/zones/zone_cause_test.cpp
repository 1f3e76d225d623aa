// The cause that the monitor states for an active zone.
#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

// A ball (0) that moves at 1 m/s at most around a post (1). The zone ends at 0.3 m.
struct BallAndPost {
  explicit BallAndPost(double max_speed = 1.0, bool may_jump = true) {
    Object ball = test::moving("ball", {test::ball(0.1)});
    ball.max_speed = max_speed;
    ball.may_jump = may_jump;
    scene = test::cell_of({test::fixed("post", {test::ball(0.1)}, test::at(0, 0, 0)), ball});
    scene.zones.push_back(test::zone_over(scene, 0.3, 0.4));
    monitor.emplace(scene);
  }
  // Runs a tick this long after the last one, with a pose of that time or none.
  const ZoneReport& tick(std::optional<double> x, std::int64_t after_ns = test::kTick) {
    now += after_ns;
    std::vector<PoseSample> samples;
    if (x) samples.push_back(test::sample(1, test::at(*x, 0, 0), now));
    return monitor->tick(samples, now).zones[0];
  }
  Scene scene;
  std::optional<Monitor> monitor;
  std::int64_t now = test::kStart;
};

void expect(const ZoneReport& zone, ZoneCause cause, std::uint32_t object) {
  EXPECT_EQ(zone.cause, cause);
  EXPECT_EQ(zone.cause_object, object);
  EXPECT_EQ(zone.active, cause != ZoneCause::kInactive);
}

TEST(ZoneCause, IsDistanceWhenTheObjectsAreNear) {
  BallAndPost cell;
  cell.tick(0.7);
  expect(cell.tick(0.7), ZoneCause::kInactive, 0);
  expect(cell.tick(0.45), ZoneCause::kNear, 0);
}

TEST(ZoneCause, IsTheObjectThatWasNeverSeen) {
  BallAndPost cell;
  expect(cell.tick(std::nullopt), ZoneCause::kUnknown, 1);
}

TEST(ZoneCause, IsALateObjectThatMayHaveComeNearUnseen) {
  BallAndPost cell;
  cell.tick(0.6);
  expect(cell.tick(0.6), ZoneCause::kInactive, 0);
  // The distance is 0.4 m. After 150 ms without a pose it may be only 0.25 m.
  expect(cell.tick(std::nullopt, 150 * test::kTick), ZoneCause::kLate, 1);
}

TEST(ZoneCause, IsTheLateObjectThatMayHaveMovedFarther) {
  for (const std::uint32_t faster : {0u, 1u}) {
    std::vector<Object> balls{test::moving("left", {test::ball(0.1)}),
                              test::moving("right", {test::ball(0.1)})};
    for (std::uint32_t i : {0u, 1u}) balls[i].max_speed = i == faster ? 2.0 : 1.0;
    Scene scene = test::cell_of(std::move(balls));
    scene.zones.push_back(test::zone_over(scene, 0.3, 0.4));
    Monitor monitor(scene);
    const std::array samples{test::sample(0, test::at(0, 0, 0), test::kStart),
                             test::sample(1, test::at(0.8, 0, 0), test::kStart)};
    expect(monitor.tick(samples, test::kStart).zones[0], ZoneCause::kInactive, 0);
    expect(monitor.tick({}, test::kStart + 150 * test::kTick).zones[0], ZoneCause::kLate, faster);
  }
}

TEST(ZoneCause, IsALateObjectWithoutAStatedSpeed) {
  BallAndPost cell(kInfinity);
  cell.tick(0.6);
  expect(cell.tick(0.6), ZoneCause::kInactive, 0);
  expect(cell.tick(std::nullopt, 21 * test::kTick), ZoneCause::kLate, 1);
}

TEST(ZoneCause, IsAnObjectWhosePosesContradictEachOther) {
  BallAndPost cell(1.0, false);
  cell.tick(0.6);
  expect(cell.tick(0.6), ZoneCause::kInactive, 0);
  // A jump of 50 m in 150 ms is refused. The position is then bounded only by 1 m/s since the pose
  // before it.
  expect(cell.tick(50.0, 150 * test::kTick), ZoneCause::kContradicted, 1);
}

TEST(ZoneCause, IsForgottenWhenTheZoneIsLeft) {
  BallAndPost cell;
  expect(cell.tick(std::nullopt), ZoneCause::kUnknown, 1);
  expect(cell.tick(0.8), ZoneCause::kInactive, 0);
  expect(cell.tick(0.45), ZoneCause::kNear, 0);
}

// The ball is far away before and after the leap. Another one is near the post, so that no tick
// needs the distance of the first. Between the two ticks it may have been anywhere.
TEST(ZoneCause, IsAFarObjectThatLeapsBetweenTwoTicks) {
  Object leaping = test::moving("leaping", {test::ball(0.1)}),
         near = test::moving("near", {test::ball(0.1)});
  leaping.may_jump = true;
  Scene scene =
      test::cell_of({test::fixed("post", {test::ball(0.1)}, test::at(0, 0, 0)), leaping, near});
  scene.zones.push_back(test::zone_over(scene, 0.3, 0.4));
  Monitor monitor(scene);
  std::int64_t now = test::kStart;
  const auto tick = [&](double x) -> const Report& {
    now += test::kTick;
    const std::array samples{test::sample(1, test::at(x, 0, 0), now),
                             test::sample(2, test::at(0.7, 0, 0), now)};
    return monitor.tick(samples, now);
  };
  tick(50.0);
  expect(tick(50.0).zones[0], ZoneCause::kInactive, 0);
  const ZoneReport leap = tick(-2e4).zones[0];
  expect(leap, ZoneCause::kDiscontinuous, 1);
  EXPECT_EQ(leap.swept_clearance, -kInfinity);
  EXPECT_GT(leap.clearance, 0.3) << "it is not there now";
  EXPECT_FALSE(leap.certified);
  expect(tick(-2e4).zones[0], ZoneCause::kInactive, 0);
}

TEST(ZoneCause, IsStillDistanceWhenANearObjectIsLate) {
  BallAndPost cell;
  cell.tick(0.45);
  cell.tick(0.45);
  expect(cell.tick(std::nullopt, 25 * test::kTick), ZoneCause::kNear, 0);
}

// A group that MoveIt fills may be empty.
TEST(ZonesWithoutPairs, AreNeverActiveAndDoNotDisturbOthers) {
  Scene scene = test::cell_of({test::fixed("post", {test::ball(0.1)}, test::at(0, 0, 0)),
                               test::moving("ball", {test::ball(0.1)})});
  scene.zones = {test::zone_over(scene, 0.3, 0.4), test::zone_over(scene, 0.3, 0.4)};
  scene.zones[0].pairs.clear();
  Monitor monitor(scene);
  std::int64_t now = test::kStart;
  // A zone is active in the tick after one inside, too: the ball was in it since then.
  for (const auto& [x, is_active] :
       {std::pair(5.0, false), std::pair(0.3, true), std::pair(0.15, true), std::pair(5.0, true),
        std::pair(5.0, false)}) {
    now += test::kTick;
    const PoseSample sample = test::sample(1, test::at(x, 0, 0), now);
    const Report& report = monitor.tick({&sample, 1}, now);
    EXPECT_FALSE(report.zones[0].active);
    EXPECT_EQ(report.zones[1].active, is_active) << x;
  }
}

}  // namespace
}  // namespace clearance
