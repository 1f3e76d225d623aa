// Oracles: the exact distance of all parts (tests/shared/exact_oracle.hpp); for whole runs, the
// same monitor with every pair evaluated in every tick.
#include "monitor/pairs/hull_bound.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <variant>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "config/write/warehouse_cell.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/simulated_samples.hpp"

namespace clearance {
namespace {

using oracle::Body;

// Two objects of several parts each, for the core and for the oracle.
struct TwoObjects {
  Scene scene;
  std::vector<std::vector<Body>> bodies{2};

  explicit TwoObjects(Random& random) {
    scene.objects.resize(2);
    for (std::size_t i = 0; i < 2; ++i) {
      const bool fine = i == 0 && random.chance(0.2);
      const int parts = fine ? 1 : random.integer(i == 0 ? 2 : 1, 3);
      for (int p = 0; p < parts; ++p) add(i, fine ? hard::facet_ball(10) : simple(random), random);
    }
    scene.pairs.push_back({0, 1, false});
  }
  static Body simple(Random& random) {
    return random.chance(0.3) ? hard::rounded(random) : hard::any_bounded(random);
  }
  void add(std::size_t object, const Body& body, Random& random) {
    bodies[object].push_back(body);
    const Pose place{random.in_box(1.0),
                     random.chance(0.3) ? Eigen::Quaterniond::Identity() : random.rotation()};
    scene.objects[object].parts.push_back({"part", test::made(body), place});
  }
  // The exact distance over all parts. The objects are not rotated, so that the products of poses
  // are exact.
  [[nodiscard]] double exact_distance(const Vec3& a, const Vec3& b) const {
    double least = kInfinity;
    for (std::size_t p = 0; p < bodies[0].size(); ++p) {
      for (std::size_t q = 0; q < bodies[1].size(); ++q) {
        Pose pose_a = scene.objects[0].parts[p].object_from_part;
        Pose pose_b = scene.objects[1].parts[q].object_from_part;
        pose_a.position += a;
        pose_b.position += b;
        least = std::min(least,
                         oracle::exact_distance(bodies[0][p], pose_a, bodies[1][q], pose_b).upper);
      }
    }
    return least;
  }
};

TEST(HullBound, IsNeverAboveTheDistanceOfTheParts) {
  Random random(201);
  int apart = 0;
  for (int round = 0; round < 60; ++round) {
    TwoObjects two(random);
    std::vector<PosedPart> parts = parts_of(two.scene);
    PairTable table(two.scene, parts);
    HullBound hulls(two.scene, parts);
    ASSERT_TRUE(hulls.possible(table.entries[0]));
    std::vector<TrackedObject> objects(2);
    for (TrackedObject& object : objects) {
      object.input.has_value = object.moved = true;
      object.pose.position = random.in_box(4.0);
    }
    for (PosedPart& part : parts) place(objects[part.object], part);
    Budget budget(10);
    const double lower = hulls.lower(0, TickView{objects, parts, 1, table}, budget);
    EXPECT_EQ(budget.left(), 9u);
    const double truth = two.exact_distance(objects[0].pose.position, objects[1].pose.position);
    // the addition of positions rounds in the oracle
    EXPECT_LE(lower, truth + 1e-14) << "round " << round;
    apart += lower > 0.0;
  }
  EXPECT_GT(apart, 30);
}

// The only part of the other object is far from its object's origin, so that the place of the part
// is not exact.
TEST(HullBound, IsLessThanTheDistanceOfTheHullByThePlacingError) {
  Scene scene;
  scene.objects.resize(2);
  const ConvexBody cube = test::made(box(Vec3::Ones()));
  scene.objects[0].parts = {{"a", cube, {}}, {"b", cube, {.position = Vec3(3, 0, 0)}}};
  scene.objects[1].parts = {{"c", cube, {Vec3(1e4, 2e4, 3e4), Random(7).rotation()}}};
  scene.pairs = {{0, 1, false}};
  std::vector<PosedPart> parts = parts_of(scene);
  PairTable table(scene, parts);
  HullBound hulls(scene, parts);
  std::vector<TrackedObject> objects(2);
  for (TrackedObject& object : objects) object.input.has_value = object.moved = true;
  objects[1].pose = {Vec3(-1e4, -2e4, -3e4), Random(8).rotation()};
  for (PosedPart& part : parts) place(objects[part.object], part);
  Budget budget(10);
  const double lower = hulls.lower(0, TickView{objects, parts, 1, table}, budget);
  const std::vector<BoundingHull> made = bounding_hulls(scene);
  PosedPart hull;
  hull.shape = made[0].get();
  hull.extent = hull.shape->bounding_radius + hull.shape->position_error;
  const PosedPart& other = parts[2];
  ASSERT_GT(other.shift_error, 1e-11);
  TrackingState cold;
  const DistanceResult found =
      distance(*hull.shape, *other.shape, relative_pose(Pose{}, other.world_from_part), cold,
               {.depth = false});
  EXPECT_LE(lower, found.lower - placing_error(hull, other));
}

TEST(HullBound, IsQueriedWhereOneObjectHasAHullAndTheOtherOneModel) {
  Scene scene;
  scene.objects.resize(5);
  const ConvexBody cube = test::made(box(Vec3::Ones()));
  const ConvexBody floor = test::half_space(Vec3::UnitZ(), -9.0);
  scene.objects[0].parts = {{"a", cube, {}}, {"b", cube, {.position = Vec3(3, 0, 0)}}};
  scene.objects[1].parts = {{"a", cube, {}}};
  scene.objects[2].parts = {{"floor", floor, {}}};
  scene.objects[3].parts = {{"floor", floor, {}}, {"a", cube, {}}};
  scene.objects[4].parts = {{"ball", test::made(hard::facet_ball(10)), {}}};
  scene.pairs = {{0, 1, false}, {0, 2, false}, {0, 3, false},
                 {1, 2, false}, {1, 4, false}, {3, 4, false}};
  const std::vector<PosedPart> parts = parts_of(scene);
  const PairTable table(scene, parts);
  const HullBound hulls(scene, parts);
  EXPECT_TRUE(hulls.possible(table.entries[0]));
  EXPECT_TRUE(hulls.possible(table.entries[1])) << "a floor alone is its own model";
  EXPECT_FALSE(hulls.possible(table.entries[2])) << "a floor and a cube have no hull";
  EXPECT_FALSE(hulls.possible(table.entries[3])) << "both are as simple as can be";
  EXPECT_TRUE(hulls.possible(table.entries[4])) << "one row, but of many facets";
  EXPECT_FALSE(hulls.possible(table.entries[5])) << "whichever object comes first";
}

// Time passes fast, so that pairs become awake and asleep continually.
TEST(HullBound, HidesNoPairThatMattersFromTheTick) {
  const auto read = parse_cell(warehouse_cell({.objects = 120, .seed = 3}), "warehouse.yaml");
  const Cell& cell = std::get<Cell>(read);
  Scene scene = cell.scene;
  for (Object& object : scene.objects) object.may_jump = true;
  scene.budget = 60;
  scene.refresh_s = 0.2;
  Scene everything = scene;
  everything.evaluate_all = true;
  everything.budget = 1'000'000;
  Monitor monitor(scene), judge(everything);
  int proved = 0;
  constexpr int kTicks = 3000;
  for (int t = 0; t < kTicks; ++t) {
    const std::int64_t now = 1'000'000'000 + 1'000'000 * static_cast<std::int64_t>(t);
    const std::vector<PoseSample> samples = simulated_samples(cell.simulation, 0.01 * t, now);
    const Report& report = monitor.tick(samples, now);
    const Report& truth = judge.tick(samples, now);
    ASSERT_TRUE(truth.minimum_certified);
    ASSERT_LE(report.lower_all, truth.minimum.upper) << "tick " << t;
    if (report.minimum_certified) {
      ++proved;
      ASSERT_LE(report.minimum.lower, truth.minimum.upper) << "tick " << t;
      ASSERT_GE(report.minimum.upper, truth.minimum.lower) << "tick " << t;
    }
    for (std::uint32_t pair = static_cast<std::uint32_t>(t) % 50; pair < scene.pairs.size();
         pair += 50) {
      ASSERT_LE(monitor.pair(pair).lower, judge.pair(pair).upper) << "tick " << t;
    }
    for (std::size_t z = 0; z < scene.zones.size(); ++z) {
      ASSERT_LE(truth.zones[z].active, report.zones[z].active) << "tick " << t;
    }
  }
  EXPECT_GT(proved, kTicks * 9 / 10);
}

}  // namespace
}  // namespace clearance
