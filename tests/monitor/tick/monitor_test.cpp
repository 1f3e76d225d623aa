#include "monitor/tick/monitor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/monitor/replay/report_bytes.hpp"
#include "tests/monitor/tick/two_balls.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;
using test::tick_with;
using test::two_balls;

TEST(Monitor, ReportsDistanceWitnessesAndNormalInTheWorld) {
  const Scene scene = two_balls();
  Monitor monitor(scene);
  Pose pose = test::at(1, 0.7, 0);
  pose.orientation = Random(51).rotation();
  const Report& report = tick_with(monitor, 0, pose, kStart);
  EXPECT_EQ(report.cycle, 1u);
  EXPECT_EQ(report.now_ns, kStart);
  EXPECT_EQ(report.newest_pose_ns, kStart);
  EXPECT_EQ(report.oldest_pose_ns, kStart);
  EXPECT_EQ(report.scene_revision, 7u);
  EXPECT_TRUE(report.minimum_known);
  EXPECT_TRUE(report.minimum_certified);
  const PairReport& pair = report.pairs.at(0);
  EXPECT_EQ(pair.status, PairStatus::kConverged);
  EXPECT_NEAR(pair.distance, 0.5, 1e-12);
  EXPECT_NEAR((pair.witness_a - Vec3(1, 0.6, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((pair.witness_b - Vec3(1, 0.1, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((pair.normal - Vec3(0, -1, 0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(pair.age_a_ns, 0);
  EXPECT_EQ(pair.age_b_ns, 0);
  EXPECT_EQ(pair.evaluated_cycle, 1u);
  EXPECT_EQ(pair.refresh_age_cycles, 0u);
}

TEST(Monitor, PutsTheWitnessPointOfABodyAKilometreAwayOnItToItsOwnRounding) {
  Random random(52);
  for (int k = 0; k < 50; ++k) {
    const Pose far{1000.0 * random.in_box(1.0).normalized(), random.rotation()};
    const Pose here{Vec3::Zero(), random.rotation()};
    std::vector<Part> parts = {test::block(Vec3(0.1, 0.2, 0.3))};
    if (k % 2 == 1) parts.push_back(test::ball(0.1));  // queried singly, not in a batch
    Scene scene = test::cell_of(
        {test::moving("far", parts), test::fixed("here", {test::capsule(1.0, 0.25)}, here)});
    scene.pairs[0].publish = true;
    Monitor monitor(scene);
    const PairReport& pair = tick_with(monitor, 0, far, kStart).pairs.at(0);
    Vec3 from_axis = here.orientation.conjugate() * pair.witness_b;
    from_axis.x() = std::max(0.0, std::abs(from_axis.x()) - 0.5);
    EXPECT_NEAR(from_axis.norm(), 0.25, 1e-15);
  }
}

TEST(Monitor, DistanceOfAnObjectIsThatOfItsClosestPart) {
  const Scene scene =
      test::cell_of({test::moving("arm", {test::ball(0.1), test::ball(0.1, test::at(0.5, 0, 0)),
                                          test::ball(0.1, test::at(0, 3, 0))}),
                     test::fixed("post", {test::ball(0.1, test::at(9, 0, 0)), test::ball(0.1)},
                                 test::at(1, 0, 0))});
  Monitor monitor(scene);
  const PairReport& pair = tick_with(monitor, 0, test::at(0.1, 0, 0), kStart).minimum;
  EXPECT_NEAR(pair.distance, 0.2, 1e-12);
  EXPECT_EQ(pair.part_a, 1u);
  EXPECT_EQ(pair.part_b, 1u);
  EXPECT_LE(pair.lower, 0.2);
  EXPECT_GE(pair.upper, 0.2);
}

TEST(Monitor, OverlapIsReportedAsSuchAndIsTheMinimum) {
  const Scene scene = test::cell_of(
      {test::moving("a", {test::block(Vec3(0.1, 0.1, 0.1))}),
       test::fixed("b", {test::block(Vec3(0.1, 0.1, 0.1))}, test::at(0.1, 0.05, 0.02)),
       test::fixed("c", {test::block(Vec3(0.1, 0.1, 0.1))}, test::at(0.3, 0, 0))});
  Monitor monitor(scene);
  const Report& report = tick_with(monitor, 0, test::at(0, 0, 0), kStart);
  EXPECT_EQ(report.minimum.pair, 0u);
  EXPECT_EQ(report.minimum.status, PairStatus::kOverlapping);
  EXPECT_NEAR(report.minimum.distance, -0.1, 1e-14);
  EXPECT_LE(report.minimum.lower, -0.1);
  EXPECT_GE(report.minimum.upper, -0.1);
  EXPECT_NEAR(report.minimum.normal.x(), 1.0, 1e-15);
  EXPECT_TRUE(report.minimum_certified);
}

TEST(Monitor, AFloorIsOneHalfSpaceThatNothingOutgrows) {
  Scene scene = test::cell_of({test::moving("block", {test::block(Vec3(0.1, 0.2, 0.3))}),
                               test::fixed("floor", {test::floor()}, test::at(0, 0, -1))});
  scene.budget = 0;
  Monitor blind(scene);
  EXPECT_EQ(tick_with(blind, 0, test::at(0, 0, 0), kStart).lower_all, -kInfinity);

  scene.budget = 1;
  Monitor monitor(scene);
  for (int t = 0; t < 100; ++t) {
    const double z = 0.01 * t;
    const Report& report = tick_with(monitor, 0, test::at(1e6 * t, 0, z), kStart + t * kTick);
    EXPECT_NEAR(report.minimum.distance, 0.7 + z, 1e-9);
    EXPECT_LE(report.minimum.lower, 0.7 + z);
    EXPECT_EQ(report.minimum.normal, Vec3(0, 0, -1));
  }
}

TEST(Monitor, ALiftedFloorCarriesItsBounds) {
  Scene scene = test::cell_of({test::moving("floor", {test::floor()}),
                               test::fixed("ball", {test::ball(0.1)}, test::at(0, 0, 1))});
  scene.objects.push_back(test::fixed("other", {test::ball(0.1)}, test::at(0, 0, 2)));
  scene.pairs.push_back({0, 2, false});
  scene.budget = 1;
  Monitor monitor(scene);
  tick_with(monitor, 0, test::at(0, 0, 0.00), kStart);
  tick_with(monitor, 0, test::at(0, 0, 0.00), kStart);
  tick_with(monitor, 0, test::at(0, 0, 0.01), kStart);
  const PairReport far = monitor.pair(1);
  EXPECT_EQ(far.status, PairStatus::kCarried);
  EXPECT_NEAR(far.lower, 1.9 - 0.01, 1e-12);
  EXPECT_LE(far.lower, 1.89);
}

// Moving objects, zones, published pairs and every kind of fault, from one seed.
class Trouble {
 public:
  explicit Trouble(std::uint64_t seed) : random_(seed) {
    std::vector<Object> objects;
    for (int i = 0; i < 8; ++i) {
      objects.push_back(test::moving(
          "arm", {test::capsule(1.0, 0.05, random_.pose(0.3)), test::block(Vec3(0.1, 0.2, 0.05))}));
      if (i % 2 == 0) objects.back().max_speed = 3.0;
      objects.back().margin = 0.01;
      poses_.push_back(random_.pose(2.0));
    }
    objects.push_back(test::fixed("floor", {test::floor()}, test::at(0, 0, -2)));
    scene_ = test::cell_of(std::move(objects));
    scene_.budget = 20;
    scene_.zones = {test::zone_over(scene_, 0.1, 0.2)};
    for (std::size_t p = 0; p < scene_.pairs.size(); p += 3) scene_.pairs[p].publish = true;
    samples_.reserve(64);
  }

  [[nodiscard]] const Scene& scene() const { return scene_; }

  const std::vector<PoseSample>& next() {
    samples_.clear();
    now_ns_ += kTick;
    for (std::uint32_t i = 0; i < poses_.size(); ++i) {
      poses_[i].position += random_.in_box(0.01);
      // Objects 3 (without a stated speed) and 4 are late for a while.
      if ((i == 3 || i == 4) && now_ns_ % (100 * kTick) > 40 * kTick) continue;
      if (random_.uniform(0, 1) < 0.3) continue;
      samples_.push_back(test::sample(i, poses_[i], now_ns_));
      if (random_.uniform(0, 1) < 0.1) samples_.back().stamp_ns += 10 * kTick;
      if (random_.uniform(0, 1) < 0.1) samples_.back().stamp_ns -= 10 * kTick;
      if (random_.uniform(0, 1) < 0.1) samples_.back().object += 3;
      if (random_.uniform(0, 1) < 0.1) samples_.back().world_from_object.orientation.w() = NAN;
    }
    return samples_;
  }
  [[nodiscard]] std::int64_t now_ns() const { return now_ns_; }

 private:
  Random random_;
  Scene scene_;
  std::vector<Pose> poses_;
  std::vector<PoseSample> samples_;
  std::int64_t now_ns_ = kStart;
};

TEST(Monitor, ATickAllocatesNothing) {
  Trouble trouble(61);
  Monitor monitor(trouble.scene());
  const void* const pairs = monitor.tick({}, kStart).pairs.data();
  for (int t = 0; t < 500; ++t) {
    const std::vector<PoseSample>& samples = trouble.next();
    const std::uint64_t before = allocations();
    const Report& report = monitor.tick(samples, trouble.now_ns());
    ASSERT_EQ(allocations() - before, 0u) << "tick " << t;
    ASSERT_EQ(report.pairs.data(), pairs);
  }
}

TEST(Monitor, SameInputsGiveTheSameBits) {
  Trouble first(62), second(62);
  Monitor one(first.scene()), other(second.scene());
  for (int t = 0; t < 500; ++t) {
    const std::vector<unsigned char> expected =
        test::bytes_of(one.tick(first.next(), first.now_ns()));
    ASSERT_EQ(test::bytes_of(other.tick(second.next(), second.now_ns())), expected) << "tick " << t;
  }
}

TEST(Monitor, EveryPairHasOneStatusAndBoundsInOrder) {
  Trouble trouble(63);
  Monitor monitor(trouble.scene());
  std::uint64_t seen = 0;
  for (int t = 0; t < 500; ++t) {
    const Report& report = monitor.tick(trouble.next(), trouble.now_ns());
    ASSERT_EQ(report.evaluated + report.carried + report.stale + report.unknown,
              report.pairs_total);
    for (std::uint32_t p = 0; p < report.pairs_total; ++p) {
      const PairReport pair = monitor.pair(p);
      seen |= 1u << static_cast<unsigned>(pair.status);
      ASSERT_LE(pair.lower, pair.upper);
      ASSERT_GE(pair.lower, report.lower_all);
      if (pair.status > PairStatus::kIterationLimit) continue;
      ASSERT_LE(pair.lower, pair.distance);
      ASSERT_GE(pair.upper, pair.distance);
    }
  }
  for (const PairStatus status :
       {PairStatus::kConverged, PairStatus::kCarried, PairStatus::kStale, PairStatus::kUnknown}) {
    EXPECT_TRUE(seen & 1u << static_cast<unsigned>(status)) << name(status) << " never came up";
  }
}

}  // namespace
}  // namespace clearance
