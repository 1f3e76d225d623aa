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

// select_share() leaves a robot to another share of the cell like this.
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

const std::string kMovingBall = "max_speed: 0.1, may_jump: true, ";
const std::string kThird = "  - {name: third, max_speed: 1, sphere: {radius: 0.1}}\n";

TEST(StoppingPairs, OfWhichSeveralAreUnknownNameTheFirst) {
  const Scene scene = test::scene_of_scara(
      {.ball = kMovingBall, .objects = kThird, .pairs = "  - {between: [arm, third]}\n"});
  const RobotStop stop = StoppingTicks(scene).tick(0.0, kTurning).stops.at(0);
  EXPECT_EQ(stop.validity, SeparationValidity::kUnknown);
  EXPECT_EQ(stop.pair, std::min(pair_between(scene, "finger", "ball"),
                                pair_between(scene, "finger", "third")));
}

TEST(StoppingPairs, OfAnObjectThatIsTakenAwayLimitNothing) {
  StoppingTicks ticks(test::scene_of_scara({.ball = kMovingBall}));
  const PoseSample in_the_path = test::sample(0, test::at(2.0, 0.2, 0.0), ticks.now + test::kTick);
  EXPECT_LT(ticks.tick(0.0, kTurning, {in_the_path}).stops.at(0).scaling, 1.0);
  ASSERT_TRUE(ticks.monitor.set_absent(0, true));
  const Report& report = ticks.tick(1e-3 * kTurning, kTurning);
  EXPECT_EQ(report.stops.at(0).scaling, 1.0);
  EXPECT_EQ(report.stops[0].validity, SeparationValidity::kMeasured);
  EXPECT_TRUE(std::isnan(report.pairs.at(0).stop_lower));
}

// A left arm beside a ball. `robots`, `sections` and `pairs` are texts that are added to the cell.
Scene left_scara_and(const std::string& robots, const std::string& sections,
                     const std::string& pairs) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::finger_urdf());
  return scene_of(
      "name: test\nunits: {length: m, angle: rad}\nrobots:\n"
      "  - {name: left, urdf: scara.urdf, prefix: left_, age_limit_ms: 20, joints: {elbow: "
      "{velocity: 2}}, stopping: {reaction_ms: 40, path: kept, time_ms: 100}}\n" +
          robots + sections +
          "objects:\n  - {name: ball, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [0, 4, "
          "0]}}\n" +
          kThird + "pairs:\n  - {between: [left, ball]}\n" + pairs,
      folder / "cell.yaml");
}
const std::string kRightScara =
    "  - {name: right, urdf: scara.urdf, prefix: right_, age_limit_ms: 20, joints: {elbow: "
    "{velocity: 2}}, base: {pose: {xyz: [5, 0, 0], rpy: [0, 0, 3.141592653589793]}}, stopping: "
    "{reaction_ms: 40, path: kept, time_ms: 100}}\n";

// All joints of these robots stand at 0.
std::vector<JointSample> standing(const Scene& scene, const std::string& prefix, std::int64_t now) {
  std::vector<JointSample> said;
  for (std::uint32_t v = 0; v < scene.variables.size(); ++v) {
    if (!scene.variables[v].name.starts_with(prefix)) continue;
    said.push_back(test::joint(v, 0.0, now));
    said.back().has_velocity = true;
  }
  return said;
}

// A robot and the bodies of a camera may be unknown if no pair of the stopping robot has them.
TEST(StoppingPairs, AreKnownWhileARobotOrACameraOfOtherPairsWasNeverHeard) {
  const Scene beside_robot = left_scara_and(kRightScara, "", "  - {between: [right, third]}\n");
  const Scene beside_camera = left_scara_and(
      "",
      "sensors: [{name: eye, points: /cam/points, depth_error: {constant: 0.01}, range: [0.3, 4], "
      "max_speed: 0.1, mount: {pose: {xyz: [0, 0, 2]}}}]\n",
      "  - {between: [third, eye]}\n");
  for (const Scene& scene : {beside_robot, beside_camera}) {
    Monitor monitor(scene);
    const Report& report = monitor.tick({}, standing(scene, "left_", test::kStart), test::kStart);
    EXPECT_EQ(report.stops.at(0).validity, SeparationValidity::kMeasured);
    EXPECT_EQ(report.stops[0].scaling, 1.0);
  }
}

// The right finger is 0.9 m away, and may have come nearer at 0.5 m/s since it was heard.
TEST(StoppingPairs, WithARobotThatIsLateCountItsLimitsInsteadOfItsStop) {
  const Scene scene = left_scara_and(kRightScara, "",
                                     "  - {between: [left, right]}\n  - {between: "
                                     "[third, ball]}\n");
  Monitor monitor(scene);
  const std::uint32_t pair = pair_between(scene, "left_finger", "right_finger");
  const auto lower_of = [&](const Report& report) {
    return std::ranges::find(report.pairs, pair, &PairReport::pair)->stop_lower;
  };
  const double both = lower_of(monitor.tick({}, standing(scene, "", test::kStart), test::kStart));
  EXPECT_NEAR(both, 0.9, kStopTolerance);
  const std::int64_t now = test::kStart + 25 * test::kTick;
  const Report& report = monitor.tick({}, standing(scene, "left_", now), now);
  EXPECT_EQ(report.stops.at(0).validity, SeparationValidity::kMeasured);
  EXPECT_EQ(report.stops.at(1).validity, SeparationValidity::kUnknown);
  EXPECT_LE(report.stops[0].clearance, 0.9 - 0.5 * (0.025 + test::kReaction));
  EXPECT_GT(report.stops[0].clearance, 0.1) << "beyond this a bound need not be tight";
  EXPECT_EQ(lower_of(report), -kInfinity) << "nothing says when the right robot stands";
}

}  // namespace
}  // namespace clearance
