// The checks between the tick's stages can fail: each receives the state that it forbids.
#include "monitor/tick/stage_borders.hpp"

#include <gtest/gtest.h>

#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

// Enables the costly checks for all tests of this program.
const bool kCostlyOnesToo = (check_costly_borders(), true);

class StageBordersDeathTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(kCostlyOnesToo);
    if (!stage_borders_are_checked()) GTEST_SKIP() << "built without CLEARANCE_INVARIANTS";
  }
};

// Two balls at a distance of 0.8 m in one zone.
Report usual_report() {
  Scene scene = test::cell_of(std::vector<Object>(2, test::moving("ball", {test::ball(0.1)})));
  scene.pairs[0].publish = true;
  scene.zones.push_back(test::zone_over(scene, 0.3, 0.4));
  Monitor monitor(scene);
  const PoseSample samples[] = {test::sample(0, test::at(0, 0, 0), test::kStart),
                                test::sample(1, test::at(1, 0, 0), test::kStart)};
  return monitor.tick(samples, test::kStart);
}

TEST_F(StageBordersDeathTest, AReportOfTheTickPasses) { check_report(usual_report()); }

TEST_F(StageBordersDeathTest, AMinimumBelowTheBoundOfAllPairsEndsTheProgram) {
  Report report = usual_report();
  report.minimum.lower = report.lower_all - 1e-9;
  EXPECT_DEATH(check_report(report), "lower_all <= report.minimum.lower");
}

TEST_F(StageBordersDeathTest, MorePairsThanThereAreEndTheProgram) {
  Report report = usual_report();
  report.carried = 5;
  EXPECT_DEATH(check_report(report), "pairs_total");
}

TEST_F(StageBordersDeathTest, AnActiveZoneWithoutACauseEndsTheProgram) {
  Report report = usual_report();
  report.zones[0].active = true;
  EXPECT_DEATH(check_report(report), "cause");
}

TEST_F(StageBordersDeathTest, AnObjectWithAnUnusablePoseEndsTheProgram) {
  const Scene scene =
      test::cell_of(std::vector<Object>(2, test::moving("ball", {test::ball(0.1)})));
  std::vector<PosedPart> parts = parts_of(scene);
  const PairTable table(scene, parts);
  std::vector<TrackedObject> objects(2);
  const std::vector<std::uint32_t> changed{0}, first = first_parts(scene);
  const TickView view{objects, parts, 1, table};
  check_displaced(changed, first, view);  // an object without a pose does not count
  objects[0].input.has_value = true;
  parts[0].placed = true;
  check_displaced(changed, first, view);
  objects[0].pose.position.x() = kNan;
  EXPECT_DEATH(check_displaced(changed, first, view), "is_usable");
}

}  // namespace
}  // namespace clearance
