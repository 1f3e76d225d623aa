// Zones with `separation` where speeds or directions are not known, or none of the pairs limits.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "monitor/zones/closing.hpp"
#include "monitor/zones/separations.hpp"
#include "tests/monitor/zones/meeting.hpp"

namespace clearance {
namespace {

using test::Meeting, test::usual_terms, test::kRobotRadius;

// The person's first pose has no twist, and is on time.
TEST(AssumedSpeeds, OfAMeasuredPersonAreTheStatedOneUntilItsSpeedIsKnown) {
  Separation terms = usual_terms();
  terms.human_speed_is_measured = true;
  Meeting meeting(terms);
  meeting.begin();
  PoseSample robot = test::sample(1, test::at(0, 0, 0), meeting.now);
  robot.has_twist = true;
  const PoseSample both[] = {test::sample(0, test::at(2, 0, 0), meeting.now), robot};
  const PairSeparation& pair = meeting.monitor->tick(both, meeting.now).separated_pairs[0];
  EXPECT_EQ(pair.validity, SeparationValidity::kAssumed);
  EXPECT_EQ(pair.human_speed, 1.6);
  EXPECT_EQ(pair.robot_speed, 0.0);
}

// No query says in which direction the person is, so a speed in any direction may lead there.
TEST(AssumedSpeeds, OfAPairThatIsNotEvaluatedCountInAllDirections) {
  Meeting known, unknown;
  unknown.scene.budget = 0;
  for (const double speed : {-0.5, 0.5}) {
    EXPECT_NEAR(known.tick(2.0, 0.0, speed).robot_speed, std::max(speed, 0.0), 1e-12);
    EXPECT_NEAR(unknown.tick(2.0, 0.0, speed).robot_speed, 0.5, 1e-12);
    EXPECT_LT(unknown.report->pairs[0].evaluated_cycle, unknown.monitor->cycle());
  }
  unknown.robot_turn = {3.0, 0, 0};
  EXPECT_NEAR(unknown.tick(2.0, 0.0, 0.5).robot_speed, 0.5 + 3.0 * kRobotRadius, 1e-12);
}

// About the direction itself, no point comes nearer by turning. About any other axis, the points of
// a half-space have no largest speed.
TEST(AssumedSpeeds, OfABodyWithoutEndThatTurnsAreUnboundedUnlessItTurnsAboutTheDirection) {
  TrackedObject body;
  body.bounding_radius = kInfinity;
  body.twist.linear = {0.5, 0.0, 0.0};
  for (int axis = 0; axis < 3; ++axis) {
    body.twist.angular = 2.0 * Vec3(Vec3::Unit(axis));
    const double speed = speed_towards(body, Vec3::UnitX(), Vec3::Zero(), kInfinity);
    if (axis == 0) {
      EXPECT_NEAR(speed, 0.5, 1e-12);
    } else {
      EXPECT_EQ(speed, kInfinity);
    }
  }
}

// Both pairs allow any speed, so the one with less to spare stands for the zone.
TEST(AssumedSpeeds, OfAZoneWhosePairsScaleAlikeAreThoseOfTheLeastRemainder) {
  for (const double first : {1.5, 3.0}) {
    Scene scene = test::cell_of({test::moving("one", {test::ball(0.1)}),
                                 test::moving("other", {test::ball(0.1)}),
                                 test::moving("robot", {test::ball(0.1)})});
    for (ObjectPair& pair : scene.pairs) pair.publish = true;
    Zone zone{"people", "people", "robot", 0.1, 0.2, {1, 2}};
    zone.separation = usual_terms();
    zone.separation->human_is_first = {1, 1};
    scene.zones = {zone};
    Monitor monitor(scene);
    std::vector<PoseSample> samples;
    for (const double x : {first, 2.0, 0.0}) {
      samples.push_back(test::sample(static_cast<std::uint32_t>(samples.size()), test::at(x, 0, 0),
                                     test::kStart));
      samples.back().has_twist = true;
    }
    const ZoneSeparation& found = monitor.tick(samples, test::kStart).separated_zones[0];
    EXPECT_EQ(found.scaling, 1.0);
    EXPECT_EQ(found.pair, first < 2.0 ? 1u : 2u);
  }
}

}  // namespace
}  // namespace clearance
