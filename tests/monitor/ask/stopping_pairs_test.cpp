// The pairs that count for the stop of a robot. Oracles: closed forms for the robot of
// stopping_scara.hpp, and the same robot in another cell.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "tests/monitor/ask/stopping_scara.hpp"

namespace clearance {
namespace {

using test::StoppingTicks, test::kStopMargin, test::kStopTolerance;

constexpr double kTurning = 1.0;  // rad/s, of the shoulder

double until_it_stands(double share = 1.0) {
  return kTurning * test::kReaction +
         0.5 * share * share * kTurning * kTurning / test::kDeceleration;
}

std::uint32_t pair_between(const Scene& scene, const std::string& a, const std::string& b) {
  for (std::uint32_t pair = 0; pair < scene.pairs.size(); ++pair) {
    const std::string& first = scene.objects[scene.pairs[pair].first].name;
    const std::string& second = scene.objects[scene.pairs[pair].second].name;
    if (std::minmax(first, second) == std::minmax(a, b)) return pair;
  }
  ADD_FAILURE() << a << ", " << b;
  return 0;
}

// The part of 8 cm about the finger of 5 cm is 3 cm nearer to the ball.
TEST(StoppingPairs, AreThoseOfWhatTheRobotCarriesAsWell) {
  const double left = 0.1;
  const double at = until_it_stands() + test::angle_before(left + 0.03);
  StoppingTicks ticks(test::scene_of_scara(
      {.at = at, .objects = "  - {name: part, attached: {to: finger}, sphere: {radius: 0.08}}\n"}));
  const std::uint32_t of_part = pair_between(ticks.scene, "part", "ball");
  const Report& report = ticks.tick(0.0, kTurning);
  const auto pair = std::ranges::find(report.pairs, of_part, &PairReport::pair);
  ASSERT_NE(pair, report.pairs.end());
  EXPECT_LE(pair->stop_lower, left + 1e-6);
  EXPECT_GE(pair->stop_lower, left - kStopTolerance - 1e-6);
  EXPECT_EQ(report.stops.at(0).pair, of_part);
  EXPECT_NEAR(report.stops[0].clearance, pair->stop_lower - kStopMargin, 1e-9);
  EXPECT_EQ(report.stops[0].scaling, 1.0);
}

// A report that does not list a pair has the same stop as one that does.
TEST(StoppingPairs, CountIfTheyAreNotPublished) {
  for (const double share : {0.6, 1.0}) {
    const double left = share < 1.0 ? kStopMargin : 0.1;
    Scene scene = test::scene_of_scara({.at = until_it_stands(share) + test::angle_before(left)});
    const RobotStop published = StoppingTicks(scene).tick(0.0, kTurning).stops.at(0);
    for (ObjectPair& pair : scene.pairs) pair.publish = false;
    StoppingTicks ticks(scene);
    const Report& report = ticks.tick(0.0, kTurning);
    EXPECT_TRUE(report.pairs.empty());
    EXPECT_NEAR(report.stops.at(0).scaling, published.scaling, 2e-3);
    EXPECT_NEAR(report.stops[0].clearance, published.clearance, kStopTolerance);
    EXPECT_EQ(report.stops[0].validity, SeparationValidity::kMeasured);
    EXPECT_EQ(report.stops[0].scaling == 1.0, share == 1.0);
  }
}

// Both are unknown while an object of the pair was never heard of.
TEST(StoppingPairs, AreUnknownIfTheyAreNotPublishedAndAnObjectWasNeverHeardOf) {
  Scene scene = test::scene_of_scara({.ball = "max_speed: 0.1, may_jump: true, "});
  for (ObjectPair& pair : scene.pairs) pair.publish = false;
  const RobotStop stop = StoppingTicks(scene).tick(0.0, kTurning).stops.at(0);
  EXPECT_EQ(stop.validity, SeparationValidity::kUnknown);
  EXPECT_EQ(stop.scaling, 0.0);
  EXPECT_EQ(stop.pair, pair_between(scene, "finger", "ball"));
}

// As select_share() leaves a robot to another share of the cell.
Scene scara_without_a_pair() {
  Scene scene =
      test::scene_of_scara({.objects = "  - {name: other, fixed: true, sphere: {radius: 0.1}}\n"
                                       "  - {name: third, max_speed: 1, sphere: {radius: 0.1}}\n",
                            .pairs = "  - {between: [other, third]}\n"});
  scene.pairs = {scene.pairs.at(pair_between(scene, "other", "third"))};
  scene.zones.at(0).pairs.clear();
  scene.zones[0].stop_margin.reset();
  return scene;
}

TEST(StoppingPairs, OfWhichARobotHasNoneLimitNothing) {
  const Scene scene = scara_without_a_pair();
  StoppingTicks ticks(scene);
  const RobotStop stop = ticks.tick(0.0, kTurning).stops.at(0);
  EXPECT_EQ(stop.validity, SeparationValidity::kMeasured);
  EXPECT_EQ(stop.scaling, 1.0);
  EXPECT_EQ(stop.share, 1.0);
  EXPECT_EQ(stop.clearance, kInfinity);
  EXPECT_NEAR(stop.time, test::kReaction + kTurning / test::kDeceleration, 1e-9);
  const RobotStop late = ticks.monitor.tick({}, {}, ticks.now + 1'000 * test::kTick).stops.at(0);
  EXPECT_EQ(late.validity, SeparationValidity::kUnknown);
  EXPECT_EQ(late.scaling, 0.0);
  EXPECT_EQ(late.clearance, -kInfinity);
  EXPECT_TRUE(std::isnan(late.time));
}

}  // namespace
}  // namespace clearance
