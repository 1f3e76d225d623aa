// Stops are written from a tick's inputs alone: in memory that stands, with the same bits each
// time.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "monitor/tick/monitor.hpp"
#include "tests/monitor/ask/arms_that_stop.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/tick/taken_over.hpp"
#include "tests/shared/allocation_count.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance {
namespace {

using test::kStart, test::kTick;

constexpr std::int64_t kApart = 100'000 * kTick;  // of postures that do not follow each other

// What arms and a person say at a tick: postures near and far, at all speeds.
struct Said {
  Said(const Scene& scene, Random& random, std::int64_t now) {
    for (std::uint32_t v = 0; v < scene.variables.size(); ++v) {
      const JointVariable& of = scene.variables[v];
      const double least = std::max(of.lower, -2.5), most = std::min(of.upper, 2.5);
      joints.push_back(test::joint(v, 0.8 * random.uniform(least, most), now));
      joints.back().has_velocity = random.chance(0.95);
      joints.back().velocity = random.unit() * of.max_speed * random.uniform(-1.0, 1.0);
    }
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
      if (scene.objects[i].name != "person") continue;
      const Pose at{.position = Vec3(0.8, 0.0, 1.0) + random.in_box(1.0)};
      poses.push_back(test::sample(i, at, now));
    }
  }
  std::vector<JointSample> joints;
  std::vector<PoseSample> poses;
};

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

// What is tracked decides the last digits of a distance, and bounds of stops begin with distances.
constexpr double kTracking = 1e-12;

void expect_nearly_same_stops(const Report& a, const Report& b) {
  ASSERT_EQ(a.stops.size(), b.stops.size());
  const auto near = [](double x, double y) { return x == y || std::abs(x - y) <= kTracking; };
  for (std::size_t i = 0; i < a.stops.size(); ++i) {
    const RobotStop &one = a.stops[i], &other = b.stops[i];
    EXPECT_PRED2(near, one.scaling, other.scaling);
    EXPECT_PRED2(near, one.clearance, other.clearance);
    EXPECT_TRUE(same_bits(one.time, other.time));
    EXPECT_EQ(one.pair, other.pair);
    EXPECT_EQ(one.validity, other.validity);
  }
  ASSERT_EQ(a.pairs.size(), b.pairs.size());
  for (std::size_t i = 0; i < a.pairs.size(); ++i) {
    const double one = a.pairs[i].stop_lower, other = b.pairs[i].stop_lower;
    EXPECT_TRUE(near(one, other) || (std::isnan(one) && std::isnan(other)));
  }
}

void expect_same_stops(const Report& a, const Report& b) {
  ASSERT_EQ(a.stops.size(), b.stops.size());
  for (std::size_t i = 0; i < a.stops.size(); ++i) {
    const RobotStop &one = a.stops[i], &other = b.stops[i];
    EXPECT_TRUE(same_bits(one.scaling, other.scaling));
    EXPECT_TRUE(same_bits(one.clearance, other.clearance));
    EXPECT_TRUE(same_bits(one.share, other.share));
    EXPECT_TRUE(same_bits(one.time, other.time));
    EXPECT_EQ(one.pair, other.pair);
    EXPECT_EQ(one.validity, other.validity);
  }
  ASSERT_EQ(a.pairs.size(), b.pairs.size());
  for (std::size_t i = 0; i < a.pairs.size(); ++i)
    EXPECT_TRUE(same_bits(a.pairs[i].stop_lower, b.pairs[i].stop_lower));
}

TEST(SteadyStops, AreWrittenWithoutAllocation) {
  std::size_t limited = 0, free = 0;
  for (std::uint64_t seed = 1; seed <= repeats(24); ++seed) {
    const Scene scene = test::drawn_scene(seed);
    Random random(seed);
    Monitor monitor(scene);
    std::int64_t now = kStart;
    for (int i = 0; i < 20; ++i) {
      now += i % 4 == 3 ? kTick : kApart;
      const Said said(scene, random, now);
      const std::uint64_t before = allocations();
      const Report& report = monitor.tick(said.poses, said.joints, now);
      EXPECT_EQ(allocations(), before) << "seed " << seed << ", tick " << i;
      for (const RobotStop& stop : report.stops) (stop.scaling < 1.0 ? limited : free) += 1;
    }
  }
  EXPECT_GT(limited, 10u);
  EXPECT_GT(free, 10u);
}

TEST(SteadyStops, HaveTheSameBitsTwiceAndHardlyOthersWhateverWasBefore) {
  for (std::uint64_t seed = 1; seed <= repeats(24); ++seed) {
    const Scene scene = test::drawn_scene(seed);
    Random random(seed);
    Monitor one(scene), other(scene);
    std::int64_t now = kStart;
    for (int i = 0; i < 10; ++i) {
      now += kApart;
      const Said said(scene, random, now);
      const Report& report = one.tick(said.poses, said.joints, now);
      expect_same_stops(report, other.tick(said.poses, said.joints, now));
      Monitor fresh(scene);
      expect_nearly_same_stops(report, fresh.tick(said.poses, said.joints, now));
    }
  }
}

TEST(SteadyStops, GoOnInAMonitorThatTakesOverOrIsRestored) {
  for (std::uint64_t seed = 1; seed <= repeats(12); ++seed) {
    const Scene scene = test::drawn_scene(seed);
    Random random(seed);
    Monitor monitor(scene);
    std::int64_t now = kStart;
    const Said said(scene, random, now);
    (void)monitor.tick(said.poses, said.joints, now);
    SourceNumbers numbers(scene);
    const auto successor = test::taken_over(monitor, scene, scene, numbers);
    std::vector<std::byte> bytes;
    StateWriter writer(bytes);
    monitor.save(writer);
    Monitor restored(scene);
    StateReader reader(bytes);
    ASSERT_TRUE(restored.restore(reader));
    // The joints said nothing since then: they are late a little.
    for (int i = 0; i < 5; ++i) {
      now += 3 * kTick;
      const Report& report = monitor.tick({}, {}, now);
      expect_nearly_same_stops(report, successor->tick({}, {}, now));
      expect_nearly_same_stops(report, restored.tick({}, {}, now));
    }
  }
}

}  // namespace
}  // namespace clearance
