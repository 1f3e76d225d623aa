// The frames of sensors as objects of the tick.
//
// Oracles: the closed form for capsules and points in long double, over every single point; a
// second monitor for repeatability.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <deque>
#include <optional>

#include "monitor/clouds/seen_cloud.hpp"
#include "monitor/interface/zone_cause.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance::seen_objects_test {
namespace {

constexpr std::uint32_t kArm = 0, kSeen = 2;  // objects: arm, hand, seen

// An arm of two capsules, a hand of one, and a sensor that sees points within 5 m.
class SeenObjects : public testing::Test {
 protected:
  SeenObjects() {
    std::vector<Object> objects;
    objects.push_back(test::moving(
        "arm", {test::capsule(0.4, 0.05), test::capsule(0.3, 0.04, test::at(0, 0.2, 0))}));
    objects.push_back(test::moving("hand", {test::capsule(0.1, 0.03)}));
    Object seen = test::moving("seen", {test::ball(5.0)});
    seen.sensor = 0;
    seen.age_limit_ns = 10 * test::kTick;
    objects.push_back(seen);
    scene = test::cell_of(std::move(objects));
    scene.sensors.resize(1);
    scene.sensors[0].object = kSeen;
    scene.sensors[0].frames_by_message = false;
    for (ObjectPair& pair : scene.pairs) pair.publish = true;
    scene.zones.push_back(test::zone_over(scene, 0.1, 0.2));
    std::erase(scene.zones[0].pairs, 0u);  // arm and hand
    make();
  }
  void make() { monitor.emplace(scene); }

  std::vector<MeasuredPoint> random_points(std::size_t count, double around) {
    std::vector<MeasuredPoint> points;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 p = around * random.direction();
      points.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()), 0.01F});
    }
    return points;
  }
  void show(const std::vector<MeasuredPoint>& points, const Pose& pose, std::int64_t stamp_ns,
            Monitor& in) {
    SeenCloud& cloud = clouds.emplace_back(SeenCloud::of_points(1000));
    ASSERT_EQ(cloud.points()->build(points, {Vec3::Zero(), 5.0}), CloudBuild::kBuilt);
    EXPECT_TRUE(in.show(0, {.cloud = &cloud, .stamp_ns = stamp_ns, .world_from_sensor = pose}));
  }
  // One point at x in the world.
  void show_point(double x) {
    show({{static_cast<float>(x), 0.0F, 0.0F, 0.0F}}, {}, now, *monitor);
  }
  // The arm at the origin and the hand far away. Returns the pair of arm and sensor.
  const PairReport& tick() {
    now += test::kTick;
    const Report& report = monitor->tick(
        std::vector{test::sample(0, {}, now), test::sample(1, test::at(0, 0, 9), now)}, now);
    return report.pairs[1];
  }
  Scene scene;  // pairs: arm-hand, arm-seen, hand-seen
  std::optional<Monitor> monitor;
  std::deque<SeenCloud> clouds;
  std::int64_t now = test::kStart;
  Random random{20261124};
};

// The distance of an object's capsules from the points, by brute force.
long double truth(const Object& object, const Pose& pose, const std::vector<MeasuredPoint>& points,
                  const Pose& world_from_sensor) {
  long double least = std::numeric_limits<long double>::infinity();
  for (const Part& part : object.parts) {
    const auto segment = test::segment_in_world(part, pose);
    for (const MeasuredPoint& p : points) {
      const test::LongVec at =
          test::exactly(world_from_sensor, Vec3(p.x, p.y, p.z).cast<long double>());
      least = std::min(least, test::point_to_segment(at, segment) - part.shape.radius - p.radius);
    }
  }
  return least;
}

TEST_F(SeenObjects, HaveBoundsThatEncloseTheDistanceToEveryPointAndRepeatToTheBit) {
  Monitor second(scene);
  std::vector<MeasuredPoint> points;
  Pose sensor;
  std::array<Pose, 2> poses;
  std::size_t evaluated = 0;
  for (int t = 0; t < 400; ++t) {
    now += test::kTick;
    if (t % 7 == 0) {
      points = random_points(300, 1.0);
      sensor = random.pose(0.5);
      show(points, sensor, now, *monitor);
      show(points, sensor, now, second);
    }
    std::vector<PoseSample> samples;
    for (std::uint32_t i = 0; i < 2; ++i) {
      if (t % 50 == 0) poses[i] = random.pose(0.3);
      poses[i].position += 0.001 * random.direction();
      samples.push_back(test::sample(i, poses[i], now));
    }
    const std::uint64_t before = allocations();
    const Report& report = monitor->tick(samples, now);
    EXPECT_EQ(allocations(), before) << "tick " << t;
    const Report& again = second.tick(samples, now);
    for (const std::uint32_t pair : {1u, 2u}) {
      const PairReport& found = report.pairs[pair];
      const auto exact =
          static_cast<double>(truth(scene.objects[pair - 1], poses[pair - 1], points, sensor));
      EXPECT_LE(found.lower, exact) << "tick " << t;
      EXPECT_GE(found.upper, exact) << "tick " << t;
      if (found.status == PairStatus::kConverged) {
        ++evaluated;
        EXPECT_LE(found.upper - found.lower, 1e-9 + clouds.back().excess());
        EXPECT_NEAR((found.witness_b - found.witness_a).dot(found.normal), exact, 1e-9);
      }
      EXPECT_EQ(found.lower, again.pairs[pair].lower);
      EXPECT_EQ(found.upper, again.pairs[pair].upper);
      EXPECT_LE(found.swept_lower, found.lower);
    }
    EXPECT_LE(report.lower_all, report.pairs[1].lower);
  }
  EXPECT_GT(evaluated, 600u);
}

TEST_F(SeenObjects, AreUnknownBeforeTheFirstFrameAndAnEmptyOneIsNotTaken) {
  EXPECT_EQ(tick().status, PairStatus::kUnknown);
  clouds.push_back(SeenCloud::of_points(10));
  EXPECT_FALSE(
      monitor->show(0, {.cloud = &clouds.back(), .stamp_ns = now, .world_from_sensor = {}}));
  EXPECT_FALSE(monitor->show(0, {.cloud = nullptr, .stamp_ns = now, .world_from_sensor = {}}));
  EXPECT_FALSE(
      monitor->show(1, {.cloud = &clouds.back(), .stamp_ns = now, .world_from_sensor = {}}));
  const PairReport& pair = tick();
  EXPECT_EQ(pair.status, PairStatus::kUnknown);
  EXPECT_EQ(pair.lower, -kInfinity);
}

TEST_F(SeenObjects, ForgetTheFormerFrameAlthoughTheSensorStandsStill) {
  show_point(1.0);
  EXPECT_NEAR(tick().lower, 0.75, 1e-6);
  show_point(3.0);
  EXPECT_NEAR(tick().lower, 2.75, 1e-6);
  show_point(0.5);
  const PairReport& near = tick();
  EXPECT_NEAR(near.lower, 0.25, 1e-6);
  EXPECT_NEAR(near.upper, 0.25, 1e-6);
  EXPECT_EQ(near.status, PairStatus::kConverged);
}

TEST_F(SeenObjects, AreUnknownWhenTheyAreLateAndStateNoSpeed) {
  show_point(1.0);
  for (int t = 0; t < 10; ++t) EXPECT_EQ(tick().status, PairStatus::kConverged);
  EXPECT_EQ(tick().status, PairStatus::kUnknown);
  show_point(1.0);
  EXPECT_EQ(tick().status, PairStatus::kConverged);
}

TEST_F(SeenObjects, MayHaveMovedSinceTheirFrameByTheSpeedThatTheyState) {
  scene.objects[kSeen].max_speed = 2.0;
  make();
  show_point(1.0);
  for (int t = 1; t <= 20; ++t) {
    const PairReport& pair = tick();
    const double path = 2.0 * t * 1e-3;
    EXPECT_NEAR(pair.lower, 0.75 - path, 1e-6) << t;
    EXPECT_NEAR(pair.upper, 0.75 + path, 1e-6) << t;
    EXPECT_EQ(pair.status, t <= 10 ? PairStatus::kConverged : PairStatus::kStale) << t;
  }
}

TEST_F(SeenObjects, CountInZonesAsOtherObjectsDoAndNeverClearThemWhenTheyAreUnknown) {
  const auto zone_is_active = [&] {
    now += test::kTick;
    return monitor
        ->tick(std::vector{test::sample(0, {}, now), test::sample(1, test::at(0, 0, 9), now)}, now)
        .zones[0]
        .active;
  };
  EXPECT_TRUE(zone_is_active()) << "nothing is known yet";
  show_point(1.0);
  EXPECT_FALSE(zone_is_active());
  show_point(0.3);
  EXPECT_TRUE(zone_is_active());
  show_point(1.0);
  EXPECT_FALSE(zone_is_active());
  for (int t = 0; t < 12; ++t) zone_is_active();
  EXPECT_TRUE(zone_is_active()) << "the frame is too old";
}

// At 20 m/s, what was 0.24 m away may be nearer than 0.1 m after 8 ms. It was farther than the zone
// is left with, so that only its motion makes the zone active.
TEST_F(SeenObjects, AreACauseByDistanceWhileTheirFrameIsOnTimeAndLateOnceItIsNot) {
  scene.objects[kSeen].max_speed = 20.0;
  make();
  const auto zone = [&] {
    now += test::kTick;
    return monitor
        ->tick(std::vector{test::sample(0, {}, now), test::sample(1, test::at(0, 0, 9), now)}, now)
        .zones[0];
  };
  zone();
  show_point(0.49);
  for (int t = 0; t < 9; ++t) {
    const ZoneReport report = zone();
    EXPECT_EQ(report.cause, report.active ? ZoneCause::kNear : ZoneCause::kInactive) << t;
    EXPECT_EQ(report.cause_object, 0u);
    EXPECT_TRUE(report.active || t < 8) << t;
  }
  zone();
  const ZoneReport late = zone();
  EXPECT_EQ(late.cause, ZoneCause::kLate);
  EXPECT_EQ(late.cause_object, kSeen);
  EXPECT_EQ(cause_text(scene, late), "usable images of seen are late");
}

TEST_F(SeenObjects, TakeNoPosesFromOthersAndNoFramesOutOfOrder) {
  show_point(1.0);
  tick();
  now += test::kTick;
  const Report& report = monitor->tick(
      std::vector{test::sample(kArm, {}, now), test::sample(kSeen, test::at(1, 0, 0), now)}, now);
  EXPECT_EQ(report.rejected[static_cast<std::size_t>(Reject::kOtherSource)], 1u);
  EXPECT_NEAR(report.pairs[1].lower, 0.75, 1e-6);
  show({{2.0F, 0.0F, 0.0F, 0.0F}}, {}, now - 5 * test::kTick, *monitor);
  EXPECT_NEAR(tick().lower, 0.75, 1e-6) << "an older frame";
  show({{2.0F, 0.0F, 0.0F, 0.0F}}, {}, now + 1'000'000'000, *monitor);
  EXPECT_NEAR(tick().lower, 0.75, 1e-6) << "a frame of the future";
  EXPECT_EQ(monitor->rejected(kSeen)[static_cast<std::size_t>(Reject::kBackwards)], 1u);
  EXPECT_EQ(monitor->rejected(kSeen)[static_cast<std::size_t>(Reject::kFuture)], 1u);
}

TEST_F(SeenObjects, KeepTheirCloudWhileItIsUsed) {
  show_point(1.0);
  const SeenCloud* first = &clouds.back();
  EXPECT_TRUE(monitor->uses(first));
  tick();
  EXPECT_TRUE(monitor->uses(first));
  show_point(2.0);
  EXPECT_TRUE(monitor->uses(first));
  EXPECT_TRUE(monitor->uses(&clouds.back()));
  tick();
  EXPECT_FALSE(monitor->uses(first));
}

// The hand is 0.43 m from the arm. What the sensor sees is at 0.75 m, and may be nearer by its
// error.
TEST_F(SeenObjects, LeaveTheMinimumUncertifiedWhereTheirWideBoundsMayBeTheClosest) {
  const auto report = [&](double error) {
    now += test::kTick;
    show_point(1.0);
    EXPECT_TRUE(monitor->show(
        0,
        {.cloud = &clouds.back(), .stamp_ns = now, .world_from_sensor = {}, .pose_error = error}));
    return monitor->tick(
        std::vector{test::sample(0, {}, now), test::sample(1, test::at(0, 0.7, 0), now)}, now);
  };
  for (const double error : {0.0, 1e-3, 0.1, 0.3, 0.33, 0.5}) {
    const Report found = report(error);
    double nearest_other = kInfinity;
    for (const PairReport& pair : found.pairs) {
      if (pair.pair != found.minimum.pair) nearest_other = std::min(nearest_other, pair.lower);
    }
    EXPECT_EQ(found.minimum_certified, nearest_other >= found.minimum.upper - 2e-9) << error;
    EXPECT_EQ(found.minimum_certified, error < 0.32);
  }
}

TEST_F(SeenObjects, HaveTheErrorOfTheirPlaceInTheirBounds) {
  show_point(1.0);
  ASSERT_TRUE(monitor->show(
      0, {.cloud = &clouds.back(), .stamp_ns = now, .world_from_sensor = {}, .pose_error = 0.01}));
  const PairReport& pair = tick();
  EXPECT_NEAR(pair.lower, 0.74, 1e-6);
  EXPECT_NEAR(pair.upper, 0.76, 1e-6);
}

}  // namespace
}  // namespace clearance::seen_objects_test
