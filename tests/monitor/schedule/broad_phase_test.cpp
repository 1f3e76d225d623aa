// The pairs that the broad phase leaves out. The truth of their bounds is tested in
// tests/monitor/adversary.
#include "monitor/schedule/broad_phase.hpp"

#include <gtest/gtest.h>

#include "monitor/tick/monitor.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

TEST(BroadPhase, AThousandPairsThatStandStillCostNothing) {
  std::vector<Object> objects(60, test::moving("ball", {test::ball(0.1)}));
  Scene scene = test::cell_of(std::move(objects));
  scene.budget = 100;
  scene.refresh_s = 1e6;
  Monitor monitor(scene);
  std::uint32_t queries = 0;
  for (int t = 0; t < 100; ++t) {
    std::vector<PoseSample> samples;
    for (std::uint32_t i = 0; i < 60; ++i) {
      samples.push_back(test::sample(i, test::at(i, 0.01 * i * i, 0), kStart + t * kTick));
    }
    const Report& report = monitor.tick(samples, kStart + t * kTick);
    EXPECT_EQ(report.minimum_certified, t > 0)
        << "a thousand pairs are looked at in the first tick";
    queries = report.queries;
  }
  EXPECT_LE(queries, 20u) << "of 1770 pairs: those of the round, and the nearest";
}

TEST(BroadPhase, SaysSoWhenNotEveryPairHasBeenLookedAt) {
  std::vector<Object> objects(60, test::moving("ball", {test::ball(0.1)}));
  Scene scene = test::cell_of(std::move(objects));
  scene.budget = 10;
  Monitor monitor(scene);
  std::vector<PoseSample> samples;
  for (std::uint32_t i = 0; i < 60; ++i) {
    samples.push_back(test::sample(i, test::at(i, 0.01 * i * i, 0), kStart));
  }
  const Report& report = monitor.tick(samples, kStart);
  EXPECT_FALSE(report.minimum_certified) << "1000 of 1770 pairs a tick";
  EXPECT_EQ(report.lower_all, -kInfinity);
  EXPECT_TRUE(monitor.tick({}, kStart).minimum_certified);
  EXPECT_GT(monitor.tick({}, kStart).lower_all, 0.0);
}

// 300 objects have 44,850 pairs, of which a tick activates 1,000 for the first time. A tick passes
// over no more than 8,000, although the last objects have met all others.
TEST(BroadPhase, MeetsAllPairsOfManyObjectsInAsManyTicksAsTheyTake) {
  std::vector<Object> objects(300, test::moving("ball", {test::ball(0.1)}));
  Scene scene = test::cell_of(std::move(objects));
  scene.budget = 10;
  Monitor monitor(scene);
  std::vector<PoseSample> samples;
  for (std::uint32_t i = 0; i < 300; ++i) {
    samples.push_back(test::sample(i, test::at(0.3 * i, 0.001 * i * i, 0), kStart));
  }
  int ticks = 1;
  for (bool met = monitor.tick(samples, kStart).minimum_certified; !met && ticks < 100; ++ticks)
    met = monitor.tick({}, kStart).minimum_certified;
  EXPECT_GE(ticks, 45);
  EXPECT_LE(ticks, 52);
}

// The bound of a pair that is 1e8 m apart is rounded by more than a nanometre.
TEST(BroadPhase, CullsPairsThatAreHoweverFarApart) {
  std::vector<Object> objects(3, test::moving("ball", {test::ball(0.1)}));
  const Scene scene = test::cell_of(std::move(objects));
  Monitor monitor(scene);
  Random random(5);
  for (int t = 0; t < 200; ++t) {
    const std::int64_t now = kStart + t * kTick;
    const double x = random.log_uniform(1e3, 9e8);
    const std::vector samples{test::sample(0, test::at(0, 0, 0), now),
                              test::sample(1, test::at(0.3, 0, 0), now),
                              test::sample(2, test::at(x, 0.1, 0.3), now)};
    const Report& report = monitor.tick(samples, now);
    EXPECT_LE(report.lower_all, 0.1 + 1e-9) << t;
  }
}

// A third object, which is far away, is not observed for up to 50 ms: it may have moved 0.1 m.
TEST(BroadPhase, AnUnobservedObjectFarAwayMakesTheBoundOfAllPairsNoWider) {
  std::vector<Object> objects(3, test::moving("ball", {test::ball(0.1)}));
  objects[2].max_speed = 2.0;
  const Scene scene = test::cell_of(std::move(objects));
  Monitor monitor(scene);
  (void)monitor.tick(std::vector{test::sample(2, test::at(9, 0, 0), kStart)}, kStart);
  for (int t = 1; t <= 50; ++t) {
    const std::int64_t now = kStart + t * kTick;
    const std::vector near{test::sample(0, test::at(0, 0, 0), now),
                           test::sample(1, test::at(0.21, 0, 0), now)};
    const Report& report = monitor.tick(near, now);
    if (t == 1) continue;  // how the two came there is not known
    EXPECT_EQ(report.stale, t > 20 ? 2u : 0u) << t;
    EXPECT_NEAR(report.lower_all, 0.01, 1e-9) << t;
    EXPECT_NEAR(report.swept_lower_all, 0.01, 1e-9) << t;
  }
}

}  // namespace
}  // namespace clearance
