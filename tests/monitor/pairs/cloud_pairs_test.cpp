// Parts that are deep in what a sensor sees. Oracle: the closed forms of boxes and balls in
// long double, over every single point.
#include "monitor/pairs/cloud_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "monitor/tick/monitor.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance {
namespace {

constexpr std::uint32_t kSeen = 2;  // objects: two arms, seen
const Vec3 kHalf(0.05, 0.04, 0.1);  // of boxes, m
constexpr double kRadius = 0.05;

// Two arms of two boxes and two ellipsoids with equal axes, and a sensor that sees points within 2
// m.
Scene arms_and_sensor() {
  std::vector<Object> objects;
  for (const char* const name : {"left", "right"}) {
    std::vector<Part> parts;
    for (int i = 0; i < 4; ++i) {
      const Pose at = test::at(0.06 * i, 0.0, 0.02 * i);
      parts.push_back(i % 2 == 0
                          ? test::block(kHalf, at)
                          : Part{"round", test::made(ellipsoid(Vec3::Constant(kRadius))), at});
    }
    objects.push_back(test::moving(name, std::move(parts)));
  }
  Object seen = test::moving("seen", {test::ball(2.0)});
  seen.sensor = 0;
  objects.push_back(seen);
  Scene scene = test::cell_of(std::move(objects));
  scene.sensors.resize(1);
  scene.sensors[0].object = kSeen;
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  return scene;
}

// Points that fill a cube of 0.8 m: 80 to 250 of them are in each part.
std::vector<MeasuredPoint> dense_points(Random& random) {
  std::vector<MeasuredPoint> points(80'000);
  for (MeasuredPoint& point : points) {
    const Vec3 at = random.in_box(0.4);
    point = {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z()),
             0.002F};
  }
  return points;
}

SeenCloud cloud_of(const std::vector<MeasuredPoint>& points) {
  SeenCloud cloud = SeenCloud::of_points(points.size());
  EXPECT_EQ(cloud.points()->build(points, {Vec3::Zero(), 2.0}), CloudBuild::kBuilt);
  return cloud;
}

long double to_box(const test::LongVec& p) {
  const test::LongVec out = p.cwiseAbs() - kHalf.cast<long double>();
  return out.cwiseMax(0.0L).norm() + std::min(out.maxCoeff(), 0.0L);
}
long double to_ball(const test::LongVec& p) { return p.norm() - kRadius; }
// The signed distance of a part of an arm at this pose from all points, which are in the world.
long double truth(const Part& part, const Pose& arm, const std::vector<MeasuredPoint>& points) {
  const Eigen::Quaternion<long double> turn = arm.orientation.cast<long double>().normalized();
  const auto to_part = [&](const MeasuredPoint& p) -> test::LongVec {
    const test::LongVec at(p.x, p.y, p.z);
    return turn.conjugate() * (at - arm.position.cast<long double>()) -
           part.object_from_part.position.cast<long double>();
  };
  long double least = std::numeric_limits<long double>::infinity();
  for (const MeasuredPoint& p : points) {
    const test::LongVec at = to_part(p);
    least = std::min(least, (part.name == "round" ? to_ball(at) : to_box(at)) - p.radius);
  }
  return least;
}

TEST(CloudPairs, DeepInACloudShareTheWorkOfATickAndBothBoundsHold) {
  Random random(41);
  const Scene scene = arms_and_sensor();
  std::vector<PosedPart> parts = parts_of(scene);
  const PairTable table(scene, parts);
  const std::vector<MeasuredPoint> points = dense_points(random);
  const SeenCloud cloud = cloud_of(points);
  CloudPairs clouds(scene, parts, table), again(scene, parts, table);
  clouds.set(0, {&cloud, 0.0});
  again.set(0, {&cloud, 0.0});
  std::size_t wide = 0, queries = 0;
  for (int tick = 0; tick < 6; ++tick) {
    const std::array<Pose, 3> poses{Pose{random.in_box(0.1), random.rotation()},
                                    Pose{random.in_box(0.1), random.rotation()}, Pose{}};
    for (PosedPart& part : parts) place_at(poses[part.object], part);
    clouds.begin_tick();
    again.begin_tick();
    std::uint32_t work = 0, unlimited = 0;
    for (std::uint32_t i = 0; i < table.part_pairs(); ++i) {
      if (!clouds.has(i)) continue;
      const PosedPart &a = parts[table.part_a(i)], &b = parts[table.part_b(i)];
      const std::uint64_t before = allocations();
      const CloudPairs::Answer found = clouds.query(i, a, b);
      EXPECT_EQ(allocations(), before);
      const auto exact = static_cast<double>(
          truth(scene.objects[a.object].parts[a.index_in_object], poses[a.object], points));
      EXPECT_LE(found.bounds.lower, exact);
      EXPECT_GE(found.bounds.upper, exact);
      EXPECT_LT(found.bounds.upper, 0.0) << "a contact, whatever is left";
      EXPECT_GT(found.bounds.lower, -1.5) << "planes bound what was not queried";
      if (found.bounds.upper - found.bounds.lower > 1e-8) {
        EXPECT_EQ(found.status, DistanceStatus::kIterationLimit);
        ++wide;
      }
      work += found.overlap_work;
      ++queries;
      const CloudPairs::Answer other = again.query(i, a, b);
      EXPECT_EQ(other.bounds.lower, found.bounds.lower);
      EXPECT_EQ(other.bounds.upper, found.bounds.upper);
      CloudTracking tracking;
      SlabBody body;
      unlimited += CloudPairs::query({&cloud, 0.0}, b, a, body, tracking).overlap_work;
    }
    // Each of the 8 parts may exceed its share by one element, which takes two queries at most.
    EXPECT_LE(work, CloudPairs::kOverlapWorkOfATick + 8 * 2 * kCostOfCurved);
    EXPECT_GT(unlimited, 2 * CloudPairs::kOverlapWorkOfATick);
  }
  EXPECT_GT(wide, queries / 3);
}

TEST(CloudPairs, WithoutAnImageOrAPoseAreNotKnown) {
  const Scene scene = arms_and_sensor();
  std::vector<PosedPart> parts = parts_of(scene);
  for (PosedPart& part : parts) place_at({}, part);
  SeenCloud cloud = SeenCloud::of_points(1);
  const std::vector<MeasuredPoint> points = {{1.0F, 0.0F, 0.0F, 0.1F}};
  ASSERT_EQ(cloud.points()->build(points, {Vec3::Zero(), 2.0}), CloudBuild::kBuilt);
  SlabBody body;
  for (const bool has_image : {false, true}) {
    for (const bool has_pose : {false, true}) {
      CloudTracking tracking;
      PosedPart part = parts.front();
      if (!has_pose) part.world_from_part.position.x() = std::nan("");
      const CloudPairs::Content content{has_image ? &cloud : nullptr, 0.0, 2.0};
      const CloudPairs::Answer found =
          CloudPairs::query(content, parts.back(), part, body, tracking);
      const bool is_known = has_image && has_pose;
      EXPECT_EQ(found.status, is_known ? DistanceStatus::kConverged : DistanceStatus::kBadPose);
      EXPECT_EQ(std::isfinite(found.bounds.lower), is_known);
      EXPECT_EQ(std::isfinite(found.bounds.upper), is_known);
      EXPECT_EQ(found.witness_a.allFinite(), is_known);
    }
  }
}

// A part that touches one element has tight bounds although seven others are deep in the cloud.
TEST(CloudPairs, LeaveSomeOfTheWorkForEveryPart) {
  Random random(43);
  Scene scene = arms_and_sensor();
  std::vector<PosedPart> parts = parts_of(scene);
  const PairTable table(scene, parts);
  std::vector<MeasuredPoint> points = dense_points(random);
  points.push_back({1.0F, 0.0F, 0.0F, 0.002F});
  const SeenCloud cloud = cloud_of(points);
  CloudPairs clouds(scene, parts, table);
  clouds.set(0, {&cloud, 0.0});
  for (PosedPart& part : parts) place_at({}, part);
  std::uint32_t last = 0;
  for (std::uint32_t i = 0; i < table.part_pairs(); ++i) last = clouds.has(i) ? i : last;
  PosedPart& touching = parts[table.part_a(last)];
  place_at(test::at(0.775, 0.0, -0.06), touching);  // the ellipsoid's centre is at x = 0.955
  clouds.begin_tick();
  CloudPairs::Answer found;
  for (std::uint32_t i = 0; i < table.part_pairs(); ++i) {
    if (clouds.has(i)) found = clouds.query(i, parts[table.part_a(i)], parts[table.part_b(i)]);
  }
  EXPECT_EQ(found.status, DistanceStatus::kOverlapping);
  EXPECT_LE(found.bounds.upper - found.bounds.lower, 1e-9);
  EXPECT_LT(clouds.overlap_work_left(), CloudPairs::kOverlapWorkOfATick / 2);
}

TEST(CloudPairs, BeyondTheWorkOfATickReportsSayThatBoundsAreWideAndTheMinimumIsNotCertified) {
  Random random(47);
  const Scene scene = arms_and_sensor();
  const std::vector<MeasuredPoint> points = dense_points(random);
  const SeenCloud cloud = cloud_of(points);
  Monitor monitor(scene), second(scene);
  std::int64_t now = test::kStart;
  std::size_t wide = 0, uncertified = 0;
  for (int tick = 0; tick < 8; ++tick) {
    now += test::kTick;
    const std::array<Pose, 2> poses{Pose{random.in_box(0.1), random.rotation()},
                                    Pose{random.in_box(0.1), random.rotation()}};
    const std::vector samples{test::sample(0, poses[0], now), test::sample(1, poses[1], now)};
    if (tick % 3 == 0) {
      for (Monitor* const each : {&monitor, &second})
        ASSERT_TRUE(each->show(0, {.cloud = &cloud, .stamp_ns = now, .world_from_sensor = {}}));
    }
    const Report& report = monitor.tick(samples, now);
    const Report& again = second.tick(samples, now);
    for (const std::uint32_t pair : {1u, 2u}) {
      long double exact = std::numeric_limits<long double>::infinity();
      for (const Part& part : scene.objects[pair - 1].parts)
        exact = std::min(exact, truth(part, poses[pair - 1], points));
      const PairReport& found = report.pairs[pair];
      EXPECT_LE(found.lower, static_cast<double>(exact));
      EXPECT_GE(found.upper, static_cast<double>(exact));
      EXPECT_LT(found.upper, 0.0);
      EXPECT_EQ(found.lower, again.pairs[pair].lower);
      EXPECT_EQ(found.upper, again.pairs[pair].upper);
      wide += found.status == PairStatus::kIterationLimit ? 1 : 0;
    }
    const PairReport& other = report.pairs[report.minimum.pair == 1 ? 2 : 1];
    if (other.status == PairStatus::kIterationLimit && other.lower < report.minimum.upper) {
      EXPECT_FALSE(report.minimum_certified);
      ++uncertified;
    }
  }
  EXPECT_GT(wide, 8u);
  EXPECT_GT(uncertified, 4u);
}

}  // namespace
}  // namespace clearance
