// The pairs that the scheduler chooses to evaluate.
#include "monitor/schedule/scheduler.hpp"

#include <gtest/gtest.h>

#include "monitor/tick/monitor.hpp"
#include "tests/monitor/adversary/adversary.hpp"
#include "tests/monitor/adversary/cells.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

TEST(Scheduler, EvaluatesWhatIsPublishedInEveryTickThatTheBudgetCovers) {
  Random random(41);
  Scene scene = test::thin_bodies(random);
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  Monitor monitor(scene);
  test::Adversary motion(scene, test::Style::kTeleport, 3.0, 42);
  for (int t = 0; t < 20; ++t) {
    const Report& report = motion.tick(monitor);
    EXPECT_EQ(report.evaluated, report.pairs_total);
    EXPECT_EQ(report.oldest_evaluation_cycles, 0u);
    EXPECT_TRUE(report.minimum_certified);
  }
}

TEST(Scheduler, EvaluatesAllWhenAskedTo) {
  Random random(41);
  Scene scene = test::thin_bodies(random);
  scene.evaluate_all = true;
  Monitor monitor(scene);
  test::Adversary motion(scene, test::Style::kCrawl, 3.0, 42);
  for (int t = 0; t < 20; ++t) EXPECT_EQ(motion.tick(monitor).evaluated, scene.pairs.size());
}

TEST(Scheduler, LeavesAloneWhatNobodyAsksForAndCannotBeTheMinimum) {
  Random random(41);
  Scene scene = test::thin_bodies(random);
  scene.refresh_s = 1e6;
  Monitor monitor(scene);
  test::Adversary motion(scene, test::Style::kCrawl, 3.0, 42);
  std::uint32_t queries = 0;
  for (int t = 0; t < 100; ++t) queries = motion.tick(monitor).queries;
  EXPECT_LT(queries, scene.pairs.size() / 2) << "the budget would cover all";
}

TEST(Scheduler, ProvesTheMinimumOnAFractionOfTheBudget) {
  Random random(43);
  Scene scene = test::thin_bodies(random);
  scene.budget = 12;  // for 70 part pairs
  Monitor monitor(scene);
  test::Adversary motion(scene, test::Style::kCrawl, 3.0, 44);
  int proved = 0;
  for (int t = 0; t < 500; ++t) proved += motion.tick(monitor).minimum_certified;
  EXPECT_GE(proved, 480);
}

// The boxes around these two corner-shaped objects are nearer to each other than the objects.
TEST(Scheduler, BoundsHoldBeforeAnythingIsEvaluated) {
  const auto corner = [](double size) {
    const std::array<Vec3, 4> points{Vec3::Zero(), size * Vec3::UnitX(), size * Vec3::UnitY(),
                                     size * Vec3::UnitZ()};
    return Part{"corner", test::made(polyhedron_from_vertices(points)), {}};
  };
  Scene scene = test::cell_of(
      {test::moving("a", {corner(1.0)}), test::fixed("b", {corner(-1.0)}, test::at(3, 3, 3))});
  scene.budget = 0;
  Monitor monitor(scene);
  const PoseSample sample = test::sample(0, test::at(0, 0, 0), kStart);
  monitor.tick(std::span(&sample, 1), kStart);
  EXPECT_LE(monitor.pair(0).lower, 7.0 / std::sqrt(3.0));
  EXPECT_GE(monitor.pair(0).upper, 7.0 / std::sqrt(3.0));
  EXPECT_GT(monitor.pair(0).lower, 0.0);
}

TEST(Scheduler, SaysWhenTheBudgetEndsBeforeTheMinimumIsProved) {
  Random random(45);
  Scene scene = test::thin_bodies(random);
  scene.budget = 1;
  Monitor monitor(scene);
  test::Adversary motion(scene, test::Style::kTeleport, 3.0, 46);
  EXPECT_FALSE(motion.tick(monitor).minimum_certified);
}

TEST(Scheduler, PartsThatCannotBeTheClosestAreNotEvaluatedAndThePairIsDecidedAllTheSame) {
  std::vector<Part> chain;
  for (int i = 0; i < 5; ++i) chain.push_back(test::ball(0.1, test::at(0, i, 0)));
  const Scene scene = test::cell_of(
      {test::moving("chain", chain), test::fixed("post", {test::ball(0.1)}, test::at(1, 0, 0))});
  Monitor monitor(scene);
  for (int t = 0; t < 5; ++t) {
    const PoseSample sample = test::sample(0, test::at(0, 1e-3 * t, 0), kStart + t * kTick);
    const Report& report = monitor.tick(std::span(&sample, 1), sample.stamp_ns);
    EXPECT_EQ(report.queries, 1u);
    EXPECT_EQ(report.evaluated, 1u);
    EXPECT_EQ(report.minimum.status, PairStatus::kConverged);
    EXPECT_EQ(report.minimum.part_a, 0u);
  }
  // After the rotation the far end is near.
  Pose turned = test::at(0, 3, 0);
  turned.orientation = Eigen::AngleAxisd(M_PI, Vec3::UnitZ());
  const PoseSample sample = test::sample(0, turned, kStart + 5 * kTick);
  const PairReport& pair = monitor.tick(std::span(&sample, 1), sample.stamp_ns).minimum;
  EXPECT_EQ(pair.part_a, 3u);
  EXPECT_NEAR(pair.distance, 0.8, 1e-12);
}

}  // namespace
}  // namespace clearance
