#include "monitor/publish/zone_log.hpp"

#include <gtest/gtest.h>

#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/logged.hpp"

namespace clearance::test {
namespace {

// A scene of some zones over the same pair, and what is logged of them.
class ZoneLogTest : public testing::Test {
 protected:
  explicit ZoneLogTest(std::size_t zones = 60) {
    scene = cell_of({moving("ball", {ball(0.1)}), fixed("post", {ball(0.1)}, at(1, 0, 0))});
    for (std::size_t i = 0; i < zones; ++i) {
      scene.zones.push_back(zone_over(scene, 0.3, 0.4));
      scene.zones.back().name = "zone" + std::to_string(i);
    }
  }
  static ZoneReport change(bool active) {
    ZoneReport report{};
    report.active = active;
    report.cause = ZoneCause::kNear;
    return report;
  }

  Scene scene;
  std::shared_ptr<Logged> logged = std::make_shared<Logged>();
  LoggedTo log{logged};
};

TEST_F(ZoneLogTest, SaysHowOftenAZoneFlickersRatherThanEachTime) {
  ZoneLog zones(scene);
  for (std::uint64_t cycle = 1; cycle <= 501; ++cycle) zones.note(3, change(cycle % 2 == 1), cycle);
  zones.note(4, change(true), 502);
  EXPECT_EQ(logged->count("zone 'zone3'"), ZoneLog::kLinesOfAZone);
  EXPECT_EQ(logged->count("zone 'zone4'"), 1u);
  zones.end_second();
  EXPECT_TRUE(logged->has("zone 'zone3' changed 497 more times in the last second; it is active"))
      << logged->text();
  EXPECT_EQ(logged->count("[zone-flickers]"), 1u);
  zones.note(3, change(false), 503);
  EXPECT_TRUE(logged->has("zone 'zone3' left at cycle 503"));
  zones.end_second();
  EXPECT_EQ(logged->count("[zone-flickers]"), 1u) << "a quiet second is no news";
}

TEST_F(ZoneLogTest, NamesTheClearanceBetweenTicksWhereItIsLess) {
  ZoneLog zones(scene);
  ZoneReport near = change(true);
  near.clearance = near.swept_clearance = 0.015;
  zones.note(3, near, 7);
  EXPECT_TRUE(logged->has("ball - post, at least 0.015 m clear [zone-near]")) << logged->text();
  near.cause = ZoneCause::kLate;
  near.swept_clearance = -0.002;
  zones.note(4, near, 8);
  EXPECT_TRUE(
      logged->has("ball - post, at least 0.015 m clear, and at least -0.002 m at every "
                  "instant since the tick before [zone-late]"))
      << logged->text();
}

TEST_F(ZoneLogTest, SaysThatNothingIsKnownOfWhatMayBeAnywhere) {
  ZoneLog zones(scene);
  ZoneReport late = change(true);
  late.cause = ZoneCause::kLate;
  late.clearance = late.swept_clearance = -kInfinity;
  zones.note(3, late, 7);
  EXPECT_TRUE(logged->has("because poses of ball are late: ball - post, unknown [zone-late]"))
      << logged->text();
}

TEST_F(ZoneLogTest, CountsTogetherWhatManyZonesDoAtOnce) {
  ZoneLog zones(scene);
  for (std::uint32_t zone = 0; zone < scene.zones.size(); ++zone) zones.note(zone, change(true), 1);
  EXPECT_EQ(logged->count("entered at cycle 1"), ZoneLog::kLinesOfAll);
  zones.end_second();
  EXPECT_EQ(logged->count("[zone-flickers]"), 5u);
  EXPECT_TRUE(logged->has("15 more changes of zones left out [zones-left-out]")) << logged->text();
}

TEST_F(ZoneLogTest, AChangeOfTheSceneDoesNotMakeRoomForMoreLines) {
  ZoneLog zones(scene);
  Scene changed = scene;
  changed.zones.erase(changed.zones.begin());
  for (std::uint64_t cycle = 1; cycle <= 20; ++cycle) zones.note(3, change(cycle % 2 == 1), cycle);
  zones.change(changed);
  for (std::uint64_t cycle = 1; cycle <= 20; ++cycle) zones.note(2, change(cycle % 2 == 1), cycle);
  EXPECT_EQ(logged->count("zone 'zone3'"), ZoneLog::kLinesOfAZone);
  zones.end_second();
  EXPECT_TRUE(logged->has("zone 'zone3' changed 36 more times")) << logged->text();
}

}  // namespace
}  // namespace clearance::test
