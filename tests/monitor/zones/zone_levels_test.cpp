#include "monitor/zones/zone_levels.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "monitor/zones/zones.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

// Three balls with the pairs 01 02 12 and margins of 0.01 each.
Scene three_balls() {
  std::vector<Object> balls(3, test::moving("ball", {test::ball(0.1)}));
  for (Object& ball : balls) ball.margin = 0.01;
  return test::cell_of(std::move(balls));
}

TEST(ZoneLevels, AreThoseOfThePairsFarthestThresholdWithBothMargins) {
  Scene scene = three_balls();
  scene.zones = {test::zone_over(scene, 0.1, 0.15), test::zone_over(scene, 0.3, 0.4)};
  scene.zones[0].pairs = {0, 1};
  scene.zones[1].pairs = {1};
  const ZoneLevels levels(scene);
  EXPECT_GT(levels.largest_threshold(0), 0.15 + 0.02);
  EXPECT_NEAR(levels.largest_threshold(0), 0.17, 1e-12);
  EXPECT_NEAR(levels.largest_threshold(1), 0.42, 1e-12);
  EXPECT_EQ(levels.largest_threshold(2), -kInfinity);
  EXPECT_FALSE(levels.has(2));
  ASSERT_EQ(levels.zones_of(1).size(), 2u);
  EXPECT_EQ(levels.members_of(0).size(), 3u);
  EXPECT_NEAR(levels.most_margins(1), 0.02, 1e-12);
}

TEST(ZoneLevels, GoByTheHysteresisOfAZone) {
  const Scene scene = three_balls();
  const Zone zone = test::zone_over(scene, 0.1, 0.15);
  EXPECT_EQ(ZoneLevels::threshold(zone, false), 0.1);
  EXPECT_GT(ZoneLevels::threshold(zone, true), 0.15);
}

TEST(ZoneLevels, OfPairsThatWaitAreThoseWithTheLargestMargins) {
  Scene scene = three_balls();
  scene.zones = {test::zone_over(scene, 0.1, 0.15)};
  const ZoneLevels levels(scene);
  const Contacts contacts(scene);
  const std::vector<TrackedObject> objects(scene.objects.size());
  for (const double distance : {0.125, 0.115}) {
    Zones zones(scene, levels, contacts);
    zones.finish(objects, {.now = distance, .since = distance}, false, 1);
    EXPECT_LE(zones.reports()[0].clearance, distance - 0.02);
    EXPECT_NEAR(zones.reports()[0].clearance, distance - 0.02, 1e-12);
    EXPECT_EQ(zones.reports()[0].active, distance < 0.12);
  }
}

TEST(ZoneLevels, AreNoneInASceneWithoutZones) {
  const ZoneLevels levels(three_balls());
  EXPECT_EQ(levels.largest_threshold(1), -kInfinity);
  EXPECT_TRUE(levels.zones_of(1).empty());
}

}  // namespace
}  // namespace clearance
