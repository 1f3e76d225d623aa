// The key `stops` of a zone, and what a cell has to state besides.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "config/cell/cell_file.hpp"
#include "tests/config/cell/stopping_cell.hpp"
#include "tests/shared/mistake_at.hpp"

namespace clearance {
namespace {

using test::mistake_at;
using testing::HasSubstr;

using StopZones = StoppingCells;

const std::string kOneTime = "{reaction_ms: 10, time_ms: 300}";
const std::string kWalkingPerson = "  - {name: person, max_speed: 1.6, sphere: {radius: 0.3}}\n";
// Besides the pairs of the arm and the post.
const std::string kPersonPairs = "  - {between: [person, arm]}\n  - {between: [person, post]}\n";

std::string zone_between(const std::string& between, const std::string& rest) {
  return "zones:\n  - {name: near, between: [" + between + "], " + rest + "}\n";
}

TEST_F(StopZones, HaveTheirMarginAndPerhapsThresholds) {
  const Scene alone =
      scene(cell(kOneTime, kWalkingPerson,
                 kPersonPairs + zone_between("person, arm", "stops: {margin: 0.05}")));
  ASSERT_EQ(alone.zones.size(), 1u);
  EXPECT_EQ(alone.zones[0].stop_margin, 0.05);
  EXPECT_EQ(alone.zones[0].enter_below, 0.0);
  EXPECT_EQ(alone.zones[0].leave_above, 0.0);
  const Scene both = scene(cell(
      kOneTime, kWalkingPerson,
      kPersonPairs +
          zone_between("person, arm", "enter_below: 0.1, leave_above: 0.2, stops: {margin: 0}")));
  EXPECT_EQ(both.zones[0].stop_margin, 0.0);
  EXPECT_EQ(both.zones[0].leave_above, 0.2);
  const Scene none =
      scene(cell(kOneTime, kWalkingPerson,
                 kPersonPairs + zone_between("person, arm", "enter_below: 0.1, leave_above: 0.2")));
  EXPECT_FALSE(none.zones[0].stop_margin);
}

TEST_F(StopZones, AreRefusedWithoutTheirMarginOrWithOneThreshold) {
  const auto with = [&](const std::string& rest) {
    return errors(cell(kOneTime, kWalkingPerson, kPersonPairs + zone_between("person, arm", rest)));
  };
  EXPECT_THAT(with("stops: {}"), mistake_at("cell.yaml:14", "found no key 'margin'", "stops"));
  EXPECT_THAT(with("stops: {margin: -1}"), mistake_at("cell.yaml:14", "-1", "until the robot"));
  EXPECT_THAT(with("stops: {margin: 1, speed: 1}"), mistake_at("cell.yaml:14", "'speed'"));
  EXPECT_THAT(with("stops: {margin: 1}, enter_below: 1"),
              mistake_at("cell.yaml:14", "found enter_below without leave_above"));
  EXPECT_THAT(with("stops: {margin: 1}, leave_above: 1"),
              mistake_at("cell.yaml:14", "found leave_above without enter_below"));
  EXPECT_THAT(with("enter_below: 1"), mistake_at("cell.yaml:14", "no key 'leave_above'"));
}

TEST_F(StopZones, NeedAPairOfARobotThatStops) {
  const std::string of_post = kPersonPairs + zone_between("person, post", "stops: {margin: 0.05}");
  EXPECT_THAT(errors(cell(kOneTime, kWalkingPerson, of_post)),
              mistake_at("cell.yaml:14", "found 'stops' of the zone 'near'", "'stopping'"));
  const std::string of_arm = kPersonPairs + zone_between("person, arm", "stops: {margin: 0.05}");
  EXPECT_THAT(errors(cell("", kWalkingPerson, of_arm)),
              mistake_at("cell.yaml:13", "found 'stops' of the zone 'near'", "'stopping'"));
  const std::string of_foot = kPersonPairs + zone_between("person, foot", "stops: {margin: 0.05}");
  EXPECT_THAT(errors(cell(kOneTime, kWalkingPerson, of_foot)),
              mistake_at("cell.yaml:14", "nothing that moves belongs to a robot"));
}

TEST_F(StopZones, CountWhatTheRobotCarries) {
  const std::string part =
      "  - {name: part, sphere: {radius: 0.1}, attached: {to: hand, touch: [rail]}}\n";
  const Scene carried =
      scene(cell(kOneTime, kWalkingPerson + part,
                 kPersonPairs + zone_between("person, part", "stops: {margin: 0.05}")));
  EXPECT_EQ(carried.zones[0].stop_margin, 0.05);
}

// While the robot stops, all else moves on.
TEST_F(StopZones, EachTrackedObjectNeedsASpeedBesideARobotThatStops) {
  const std::string cart = "  - {name: cart, sphere: {radius: 0.3}}\n",
                    pairs = "  - {between: [cart, arm]}\n";
  EXPECT_EQ(errors(cell("", cart, pairs)), "");
  EXPECT_THAT(
      errors(cell(kOneTime, cart, pairs)),
      mistake_at("cell.yaml:8", "found 'cart' without max_speed", "the robot 'arm' with 'stopping'",
                 "could be anywhere while the robot stops"));
  EXPECT_EQ(errors("defaults: {max_speed: 2}\n" + cell(kOneTime, cart, pairs)), "");
  const std::string load =
      "  - {name: box, sphere: {radius: 0.1}, attached: {to: cart, touch: [cart]}}\n";
  const std::string slow_cart = "  - {name: cart, max_speed: 1, sphere: {radius: 0.3}}\n";
  EXPECT_THAT(errors(cell(kOneTime, slow_cart + load, pairs)),
              mistake_at("cell.yaml:9", "found 'box' without max_speed"))
      << "it may be far from the cart";
}

TEST_F(StopZones, ABaseOnTfNeedsSpeedsBesideARobotThatStops) {
  const std::string world = "ros2: {world_frame: map}\n";
  const std::string slow = ", base: {frame: odom, max_speed: 1, max_turn_speed: 90}";
  EXPECT_EQ(errors(world + cell(kOneTime, "", "", slow)), "");
  EXPECT_THAT(errors(world + cell(kOneTime, "", "", ", base: {frame: odom, max_speed: 1}")),
              mistake_at("cell.yaml:5", "the base of 'arm' on the frame 'odom'", "max_turn_speed"));
  const Scene moving = scene(world + cell(kOneTime, "", "", slow));
  EXPECT_EQ(moving.robots[0].stopping.joints[0].time(1.0), 0.0) << "the base has no stop";
  EXPECT_NEAR(stop(moving, "shoulder").time(1.0), 0.3, 1e-12);
}

// A share keeps ids: a zone without pairs stays, and demands nothing.
TEST_F(StopZones, OfAShareWithoutTheirPairsHaveNoMargin) {
  const std::string text =
      cell(kOneTime, kWalkingPerson,
           kPersonPairs + zone_between("person, arm", "stops: {margin: 0.05}") +
               "shares:\n  - {name: people, pairs: [{between: [person, arm]}, {between: [person, "
               "post]}]}\n  - {name: still, pairs: [{between: [arm, post]}]}\n");
  const auto share = [&](const std::string& name) {
    return std::get<Cell>(parse_cell(text, folder_ / "cell.yaml", {.share = name})).scene;
  };
  EXPECT_EQ(share("people").zones[0].stop_margin, 0.05);
  EXPECT_FALSE(share("still").zones[0].stop_margin);
}

}  // namespace
}  // namespace clearance
