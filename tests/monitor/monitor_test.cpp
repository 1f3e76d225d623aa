#include "monitor/monitor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "tests/monitor/small_cells.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;
using test::Random;

// Two balls of radius 0.1; the second fixed, 1 m along x.
Scene two_balls() {
  Scene scene = test::cell_of({test::moving("a", {test::ball(0.1)}),
                               test::fixed("b", {test::ball(0.1)}, test::at(1, 0, 0))});
  scene.pairs[0].publish = true;
  return scene;
}

const Report& tick_with(Monitor& monitor, std::uint32_t object, const Pose& pose,
                        std::int64_t now_ns) {
  const PoseSample sample = test::sample(object, pose, now_ns);
  return monitor.tick(std::span(&sample, 1), now_ns);
}

TEST(Monitor, ReportsDistanceWitnessesAndNormalInTheWorld) {
  const Scene scene = two_balls();
  Monitor monitor(scene);
  Pose pose = test::at(1, 0.7, 0);
  pose.orientation = Random(51).orientation();
  const Report& report = tick_with(monitor, 0, pose, kStart);
  EXPECT_EQ(report.cycle, 1u);
  EXPECT_EQ(report.now_ns, kStart);
  EXPECT_EQ(report.newest_pose_ns, kStart);
  EXPECT_EQ(report.oldest_pose_ns, kStart);
  EXPECT_EQ(report.scene_revision, 7u);
  EXPECT_TRUE(report.minimum_known);
  EXPECT_TRUE(report.minimum_proved);
  const PairReport& pair = report.pairs.at(0);
  EXPECT_EQ(pair.status, PairStatus::kConverged);
  EXPECT_NEAR(pair.distance, 0.5, 1e-12);
  EXPECT_NEAR((pair.witness_a - Vec3(1, 0.6, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((pair.witness_b - Vec3(1, 0.1, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((pair.normal - Vec3(0, -1, 0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(pair.age_a_ns, 0);
  EXPECT_EQ(pair.age_b_ns, 0);
  EXPECT_EQ(pair.evaluated_cycle, 1u);
}

TEST(Monitor, TimeToContactFollowsFromFiniteDifferencesOfPoses) {
  const Scene scene = two_balls();
  Monitor monitor(scene);
  tick_with(monitor, 0, test::at(0.400, 0, 0), kStart);
  const Report& report = tick_with(monitor, 0, test::at(0.401, 0, 0), kStart + kTick);
  EXPECT_NEAR(report.minimum.closing_speed, 1.0, 1e-9);
  EXPECT_NEAR(report.minimum.time_to_contact, 0.399, 1e-9);
}

TEST(Monitor, ClosingSpeedIsUnknownWhileAVelocityIs) {
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

TEST(Monitor, VelocitySentWithTheFirstPoseIsKnownAtOnce) {
  const Scene scene = two_balls();
  Monitor monitor(scene);
  PoseSample sample = test::sample(0, test::at(0, 0, 0), kStart);
  sample.has_twist = true;
  sample.twist.linear = Vec3(2, 0, 0);
  const Report& report = monitor.tick(std::span(&sample, 1), kStart);
  EXPECT_NEAR(report.minimum.closing_speed, 2.0, 1e-12);
  EXPECT_NEAR(report.minimum.time_to_contact, 0.4, 1e-12);
}

TEST(Monitor, NothingIsKnownBeforeTheFirstPose) {
  const Scene scene = two_balls();
  Monitor monitor(scene);
  const Report& report = monitor.tick({}, kStart);
  EXPECT_FALSE(report.minimum_known);
  EXPECT_FALSE(report.minimum_proved);
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

TEST(Monitor, LatePosesDecayTheBoundsByTheStatedSpeedAndSaySo) {
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
  EXPECT_FALSE(late.minimum_proved);
  EXPECT_TRUE(monitor.input_age(0).stale);

  const Report& back = tick_with(monitor, 0, test::at(0.1, 0, 0), kStart + 101 * kTick);
  EXPECT_EQ(back.stale, 0u);
  EXPECT_NEAR(back.pairs[0].lower, 0.7, 1e-12);
  EXPECT_FALSE(monitor.input_age(0).stale);
}

TEST(Monitor, LatePosesWithoutAStatedSpeedAreUnknownUntilTheNextPose) {
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
  EXPECT_TRUE(back.minimum_proved);
}

// Oracle: anywhere the object can be by then, given its speed.
TEST(Monitor, StaleBoundsHoldWhereverTheObjectWentSince) {
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
    a.position += 0.05 * 1.5 * random.vec(1.0).normalized();
    const long double truth = test::true_distance(scene.objects[0], a, scene.objects[1], b);
    const PairReport pair = monitor.pair(0);
    ASSERT_EQ(pair.status, PairStatus::kStale);
    ASSERT_LE(pair.lower, truth);
    ASSERT_GE(pair.upper, truth);
  }
}

TEST(Monitor, RefusedSamplesAreCountedByCauseAndNeverUsed) {
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
      test::sample(1, test::at(0.5, 0, 0), kStart),   // fixed
      test::sample(99, test::at(0.5, 0, 0), kStart),  // no such object
  };
  const Report& report = monitor.tick(samples, kStart + kTick);
  EXPECT_EQ(monitor.rejected(0), (std::array<std::uint64_t, kRejects>{0, 1, 2, 1, 1, 0}));
  EXPECT_EQ(monitor.rejected(1), (std::array<std::uint64_t, kRejects>{1, 0, 0, 0, 0, 0}));
  EXPECT_EQ(report.rejected, (std::array<std::uint64_t, kRejects>{2, 1, 2, 1, 1, 0}));
  EXPECT_NEAR(report.minimum.distance, 0.8, 1e-12);
  EXPECT_EQ(report.newest_pose_ns, kStart);

  monitor.refuse(0, Reject::kWrongRevision);
  monitor.refuse(99, Reject::kWrongRevision);
  EXPECT_EQ(monitor.rejected(0)[static_cast<std::size_t>(Reject::kWrongRevision)], 1u);
  const Report& next = monitor.tick({}, kStart + 2 * kTick);
  EXPECT_EQ(next.rejected[static_cast<std::size_t>(Reject::kWrongRevision)], 2u);
}

TEST(Monitor, TimeThatGoesBackwardsStandsStill) {
  const Scene scene = two_balls();
  Monitor monitor(scene);
  tick_with(monitor, 0, test::at(0, 0, 0), kStart);
  const Report& report = monitor.tick({}, kStart - 100 * kTick);
  EXPECT_EQ(report.now_ns, kStart);
  EXPECT_EQ(report.minimum.age_a_ns, 0);
}

TEST(Monitor, TheLastOfSeveralSamplesOfATickIsUsed) {
  const Scene scene = two_balls();
  Monitor monitor(scene);
  const std::array samples{test::sample(0, test::at(0.3, 0, 0), kStart),
                           test::sample(0, test::at(0.1, 0, 0), kStart + 1),
                           test::sample(0, test::at(0.2, 0, 0), kStart)};
  EXPECT_NEAR(monitor.tick(samples, kStart).minimum.distance, 0.7, 1e-12);
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
  EXPECT_TRUE(report.minimum_proved);
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

// Moving objects, zones, published pairs and every kind of trouble, from one seed.
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
      poses_[i].position += random_.vec(0.01);
      // Late for a while: 3, of which nobody states a speed, and 4.
      if ((i == 3 || i == 4) && now_ns_ % (100 * kTick) > 40 * kTick) continue;
      if (random_.in(0, 1) < 0.3) continue;
      samples_.push_back(test::sample(i, poses_[i], now_ns_));
      if (random_.in(0, 1) < 0.1) samples_.back().stamp_ns += 10 * kTick;
      if (random_.in(0, 1) < 0.1) samples_.back().stamp_ns -= 10 * kTick;
      if (random_.in(0, 1) < 0.1) samples_.back().object += 3;
      if (random_.in(0, 1) < 0.1) samples_.back().world_from_object.orientation.w() = NAN;
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

template <class T>
void append(std::vector<unsigned char>& bytes, const T& figure) {
  const std::size_t size = bytes.size();
  bytes.resize(size + sizeof(T));
  std::memcpy(bytes.data() + size, &figure, sizeof(T));
}

void append(std::vector<unsigned char>& bytes, const PairReport& pair) {
  append(bytes, pair.status);
  append(bytes, pair.evaluated_cycle);
  append(bytes, pair.part_a);
  append(bytes, pair.part_b);
  for (const double figure :
       {pair.distance, pair.lower, pair.upper, pair.closing_speed, pair.time_to_contact}) {
    append(bytes, figure);
  }
  for (const Vec3& v : {pair.witness_a, pair.witness_b, pair.normal}) {
    for (int i = 0; i < 3; ++i) append(bytes, v[i]);
  }
}

std::vector<unsigned char> bytes_of(const Report& report) {
  std::vector<unsigned char> bytes;
  append(bytes, report.queries);
  append(bytes, report.minimum_proved);
  append(bytes, report.lower_all);
  append(bytes, report.minimum);
  for (const PairReport& pair : report.pairs) append(bytes, pair);
  for (const ZoneReport& zone : report.zones) {
    append(bytes, zone.active);
    append(bytes, zone.proved);
    append(bytes, zone.clearance);
    append(bytes, zone.pair);
  }
  append(bytes, report.rejected);
  return bytes;
}

TEST(Monitor, SameInputsGiveTheSameBits) {
  Trouble first(62), second(62);
  Monitor one(first.scene()), other(second.scene());
  for (int t = 0; t < 500; ++t) {
    const std::vector<unsigned char> expected = bytes_of(one.tick(first.next(), first.now_ns()));
    ASSERT_EQ(bytes_of(other.tick(second.next(), second.now_ns())), expected) << "tick " << t;
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
      if (pair.status > PairStatus::kLoose) continue;
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
