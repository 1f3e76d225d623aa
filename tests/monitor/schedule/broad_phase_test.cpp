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
  std::vector<Object> objects;
  for (int i = 0; i < 60; ++i) objects.push_back(test::moving("ball", {test::ball(0.1)}));
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
  std::vector<Object> objects;
  for (int i = 0; i < 60; ++i) objects.push_back(test::moving("ball", {test::ball(0.1)}));
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

}  // namespace
}  // namespace clearance
