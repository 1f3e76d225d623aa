// Stops of a robot beside one ball. Oracles: closed forms.
#include <cmath>

#include "monitor/clouds/seen_cloud.hpp"
#include "tests/monitor/ask/stopping_scara.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance {
namespace {

using test::kReaction, test::kTick;
using test::scene_of_scara;
using test::StoppingScara;
using test::StoppingTicks;

constexpr double kDeceleration = test::kDeceleration;
constexpr double kSame = 2e-3;  // of a share: where a motion is not clear any more

// A joint slows down from this share of its speed, after the reaction at its full speed.
double angle_to_stop(double speed, double share = 1.0) {
  return speed * kReaction + 0.5 * share * share * speed * speed / kDeceleration;
}

void expect_unknown(const Report& report) {
  EXPECT_EQ(report.stops.at(0).scaling, 0.0);
  EXPECT_EQ(report.stops[0].validity, SeparationValidity::kUnknown);
  EXPECT_EQ(report.stops[0].clearance, -kInfinity);
  EXPECT_EQ(report.pairs.at(0).stop_lower, -kInfinity);
}

TEST(StoppingScaras, AreAsNearAsTheyComeUntilTheyStand) {
  Random random(59);
  for (std::uint64_t i = 0; i < repeats(200); ++i) {
    const double speed = random.uniform(0.0, 2.0);
    const double left = random.uniform(0.06, 0.14);  // m: less than 10 cm above the margin
    const double at = angle_to_stop(speed) + test::angle_before(left);
    StoppingTicks ticks(scene_of_scara({.at = at}));
    const Report& report = ticks.tick(0.0, speed);
    EXPECT_EQ(report.stops.at(0).validity, SeparationValidity::kMeasured);
    EXPECT_EQ(report.stops[0].scaling, 1.0);
    EXPECT_LE(report.pairs.at(0).stop_lower, left + 1e-6);
    EXPECT_GE(report.pairs[0].stop_lower, left - test::kStopTolerance - 1e-6);
    EXPECT_NEAR(report.stops[0].clearance, report.pairs[0].stop_lower - test::kStopMargin, 1e-9);
    EXPECT_NEAR(report.stops[0].time, kReaction + speed / kDeceleration, 1e-9);
  }
}

TEST(StoppingScaras, SlowDownToTheShareThatEndsAtTheMargin) {
  Random random(60);
  for (std::uint64_t i = 0; i < repeats(200); ++i) {
    const double speed = random.uniform(0.4, 2.0), share = random.uniform(0.1, 0.95);
    const double at = angle_to_stop(speed, share) + test::angle_before(test::kStopMargin);
    StoppingTicks ticks(scene_of_scara({.at = at}));
    const RobotStop& stop = ticks.tick(0.0, speed).stops.at(0);
    EXPECT_LE(stop.scaling, share + 1e-5);
    // An angle of a thousandth of the whole is this much of the share.
    const double slope = share * speed * speed / kDeceleration;
    EXPECT_GE(stop.scaling, share - kSame * angle_to_stop(speed) / slope);
    EXPECT_LT(stop.clearance, 0.0);
    EXPECT_EQ(stop.pair, 0u);
    EXPECT_NEAR(stop.share, angle_to_stop(speed, share) / angle_to_stop(speed), kSame);
  }
}

TEST(StoppingScaras, GoOnForTheirTimeAsFastAsAtFirst) {
  const double speed = 1.2, time = 0.25, share = 0.6;
  const double at = speed * (kReaction + share * time) + test::angle_before(test::kStopMargin);
  StoppingTicks ticks(scene_of_scara({.shoulder = "time_ms: 250", .at = at}));
  EXPECT_NEAR(ticks.tick(0.0, speed).stops.at(0).scaling, share, kSame);
}

TEST(StoppingScaras, HaveNoShareLeftIfTheyReachTheMarginBeforeTheBrakesAct) {
  const double at = 0.9 * kReaction + test::angle_before(test::kStopMargin);
  StoppingTicks ticks(scene_of_scara({.at = at}));
  EXPECT_EQ(ticks.tick(0.0, 1.0).stops.at(0).scaling, 0.0);
}

TEST(StoppingScaras, MoveAwayFreely) {
  StoppingTicks ticks(scene_of_scara({.at = test::angle_before(0.051)}));
  EXPECT_EQ(ticks.tick(0.0, -2.0).stops.at(0).scaling, 1.0);
}

TEST(StoppingScaras, ThatStandAreLimitedByNothingThatIsFarther) {
  StoppingTicks ticks(scene_of_scara({.at = test::angle_before(0.06)}));
  const Report& report = ticks.tick(0.0, 0.0);
  EXPECT_EQ(report.stops.at(0).scaling, 1.0);
  EXPECT_NEAR(report.pairs.at(0).stop_lower, report.pairs[0].lower, 1e-6);
}

// By itself, the shoulder may come to rest anywhere up to where its path would end.
TEST(StoppingScaras, ThatLeaveTheirPathStayInTheirBoxes) {
  const double speed = 1.0, left = 0.1;
  const double at = angle_to_stop(speed) + test::angle_before(left);
  StoppingTicks ticks(scene_of_scara({.path = test::kLeft, .at = at}));
  const Report& report = ticks.tick(0.0, speed);
  EXPECT_LE(report.pairs.at(0).stop_lower, left + 1e-6);
  EXPECT_GE(report.pairs[0].stop_lower, left - test::kStopTolerance - 2e-3);
  EXPECT_EQ(report.stops.at(0).scaling, 1.0);
}

// By halves of a share: sixteenths.
TEST(StoppingScaras, ThatLeaveTheirPathHaveAShareThatIsProven) {
  const double speed = 1.0, share = 0.6;
  const double at = angle_to_stop(speed, share) + test::angle_before(test::kStopMargin);
  StoppingTicks ticks(scene_of_scara({.path = test::kLeft, .at = at}));
  const double scaling = ticks.tick(0.0, speed).stops.at(0).scaling;
  EXPECT_LE(scaling, share);
  EXPECT_GE(scaling, share - 1.0 / 8.0);
}

TEST(StoppingScaras, KeepTheMarginsOfBothObjectsAsWell) {
  const double speed = 1.0, share = 0.7;
  const double at = angle_to_stop(speed, share) + test::angle_before(test::kStopMargin + 0.02);
  StoppingTicks ticks(scene_of_scara({.at = at, .ball = "fixed: true, margin: 0.02, "}));
  EXPECT_NEAR(ticks.tick(0.0, speed).stops.at(0).scaling, share, 2.0 * kSame);
}

TEST(StoppingScaras, AreUnknownWhileAJointIsLate) {
  StoppingTicks ticks(scene_of_scara({.at = 1.0}));
  EXPECT_EQ(ticks.tick(0.0, 1.0).stops.at(0).scaling, 1.0);
  expect_unknown(ticks.monitor.tick({}, {}, ticks.now + 25 * kTick));
}

TEST(StoppingScaras, AreUnknownBeforeAJointIsHeard) {
  StoppingTicks ticks(scene_of_scara({.at = 1.0}));
  expect_unknown(ticks.monitor.tick({}, {}, ticks.now));
}

// A leap that no joint can make: the positions contradict each other.
TEST(StoppingScaras, AreUnknownWhileAJointIsContradicted) {
  StoppingTicks ticks(scene_of_scara({.at = 1.0}));
  for (int i = 0; i < 10; ++i) ticks.tick(0.0, 0.0);
  const Report& report = ticks.tick(-2.5, 0.0);
  expect_unknown(report);
}

const std::string kTracked = "max_speed: 0.1, may_jump: true, ";

Scene beside_a_tracked_ball() { return scene_of_scara({.ball = kTracked}); }
PoseSample ball_at(double angle, std::int64_t now) {
  return test::sample(0, test::at(2.0 * std::cos(angle), 2.0 * std::sin(angle), 0), now);
}

TEST(StoppingScaras, AreUnknownBesideAnObjectThatWasNeverHeardOf) {
  StoppingTicks ticks(beside_a_tracked_ball());
  expect_unknown(ticks.tick(0.0, 0.1));
}

TEST(StoppingScaras, AreNotLimitedByWhatIsAbsent) {
  StoppingTicks ticks(beside_a_tracked_ball());
  ASSERT_TRUE(ticks.monitor.set_absent(0, true));
  const Report& report = ticks.tick(0.0, 2.0);
  EXPECT_EQ(report.stops.at(0).scaling, 1.0);
  EXPECT_TRUE(std::isnan(report.pairs.at(0).stop_lower));
}

// The ball moves by its largest speed until the robot stands.
TEST(StoppingScaras, AreNearerToWhatMoves) {
  const double speed = 1.0, left = 0.1;
  const double time = kReaction + speed / kDeceleration;
  const double at = angle_to_stop(speed) + test::angle_before(left + 0.1 * time);
  StoppingTicks ticks(beside_a_tracked_ball());
  const Report& report = ticks.tick(0.0, speed, {ball_at(at, ticks.now + kTick)});
  EXPECT_LE(report.pairs.at(0).stop_lower, left + 1e-6);
  EXPECT_GE(report.pairs[0].stop_lower, left - test::kStopTolerance - 1e-6);
}

TEST(StoppingScaras, AreNotLimitedByAnObjectWithoutAPair) {
  const std::string other =
      "  - {name: other, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [2, 0, 0]}}\n"
      "  - {name: third, max_speed: 1, sphere: {radius: 0.1}}\n";
  StoppingTicks ticks(
      scene_of_scara({.at = 1.5, .objects = other, .pairs = "  - {between: [other, third]}\n"}));
  const Report& report = ticks.tick(0.0, 1.0);
  EXPECT_EQ(report.stops.at(0).scaling, 1.0);
  EXPECT_EQ(report.stops[0].validity, SeparationValidity::kMeasured);
}

TEST(StoppingScaras, AreNotLimitedByAContactThatIsAllowedNow) {
  const std::string allowed =
      "contacts: [{name: touch, between: [finger, ball], by: test, reason: it is meant, depth: "
      "0.05, until: {duration_ms: 10}}]\n";
  StoppingTicks ticks(scene_of_scara({.at = 0.2, .rest = allowed}));
  EXPECT_EQ(ticks.tick(0.0, 1.0).stops.at(0).scaling, 1.0);
  for (int i = 0; i < 15; ++i) ticks.tick(0.0, 1.0);
  EXPECT_LT(ticks.tick(0.0, 1.0).stops.at(0).scaling, 1.0) << "it has ended";
}

// The first position of a joint has no velocity.
TEST(StoppingScaras, AssumeTheLimitsOfVelocitiesThatAreNotKnown) {
  const double most = 2.0 * kReaction + 0.5 * 4.0 / kDeceleration;
  for (const bool is_near : {false, true}) {
    const double at = is_near ? most : most + 0.5;
    StoppingTicks ticks(scene_of_scara({.at = at}));
    ticks.now += kTick;
    auto said = test::joints(0.0, 0.0, 0.0, ticks.now);
    said[1].has_velocity = said[2].has_velocity = true;
    const Report& report = ticks.monitor.tick({}, said, ticks.now);
    EXPECT_EQ(report.stops.at(0).validity, SeparationValidity::kAssumed);
    EXPECT_EQ(report.stops[0].scaling == 1.0, !is_near);
    EXPECT_LE(report.pairs.at(0).stop_lower, std::max(0.0, test::distance_before(at - most)));
  }
}

// The shoulder says that it hardly moves, and its positions say 1 rad/s.
TEST(StoppingScaras, CountTheLargerOneOfVelocitiesThatContradict) {
  StoppingTicks ticks(scene_of_scara({.at = 2.5}));
  const Report* report = nullptr;
  for (int i = 0; i < 400; ++i) report = &ticks.tick(1e-3 * i, 0.1);
  EXPECT_NEAR(report->stops.at(0).time, kReaction + 1.0 / kDeceleration, 1e-6);
}

TEST(StoppingScaras, AreUnknownWhilePositionsDoNotFollowAVelocity) {
  StoppingTicks ticks(scene_of_scara({.at = 2.5}));
  for (int i = 0; i < 400; ++i) ticks.tick(1e-4 * i, 1.0);
  expect_unknown(ticks.tick(0.04, 1.0));
}

// Two of them at a distance of 5 m: the right one reaches to 3 m, the left one to 2.05 m.
Scene two_of_them(const std::string& right) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::finger_urdf());
  const std::string stops = "stopping: {reaction_ms: 40, path: kept, time_ms: 100}";
  return scene_of(
      "name: test\nunits: {length: m, angle: rad}\nrobots:\n"
      "  - {name: left, urdf: scara.urdf, prefix: left_, joints: {elbow: {velocity: 2}}, " +
          stops +
          "}\n  - {name: right, urdf: scara.urdf, prefix: right_, joints: {elbow: {velocity: 2}}, "
          "base: {pose: {xyz: [5, 0, 0], rpy: [0, 0, 3.141592653589793]}}" +
          (right.empty() ? "" : ", " + stops) +
          "}\npairs: [{between: [left, right]}]\nzones: [{name: stops, between: [left, right], "
          "stops: {margin: 0.8}}]\n",
      folder / "cell.yaml");
}

TEST(StoppingScaras, BesideAnotherThatStopsCountItsStopAndElseItsLimits) {
  for (const bool stops : {true, false}) {
    const Scene scene = two_of_them(stops ? "stops" : "");
    Monitor monitor(scene);
    std::vector<JointSample> said;
    for (std::uint32_t v = 0; v < scene.variables.size(); ++v) {
      said.push_back(test::joint(v, 0.0, test::kStart));
      said.back().has_velocity = true;
    }
    const Report& report = monitor.tick({}, said, test::kStart);
    EXPECT_EQ(report.stops.size(), stops ? 2u : 1u);
    if (stops) {
      EXPECT_NEAR(report.pairs.at(0).stop_lower, 0.9, test::kStopTolerance) << "both stand";
      EXPECT_EQ(report.stops.at(0).scaling, 1.0);
    } else {
      // By 0.5 m/s along the line for the reaction, and somewhat more by its turning joints.
      EXPECT_LE(report.pairs.at(0).stop_lower, 0.9 - 0.5 * kReaction);
      EXPECT_GT(report.pairs[0].stop_lower, 0.5);
      EXPECT_EQ(report.stops.at(0).scaling, 0.0);
    }
  }
}

// A finger comes to its limit while it stops, and does not go beyond.
TEST(StoppingScaras, BesideOneThatSlidesToItsLimitAreKnown) {
  const Scene scene = two_of_them("stops");
  Monitor monitor(scene);
  std::vector<JointSample> said;
  for (std::uint32_t v = 0; v < scene.variables.size(); ++v) {
    const bool slides = scene.variables[v].name.ends_with("push");
    said.push_back(test::joint(v, slides ? 0.19 : 0.0, test::kStart));
    said.back().has_velocity = true;
    said.back().velocity = slides ? 0.5 : 0.0;
  }
  const Report& report = monitor.tick({}, said, test::kStart);
  for (const RobotStop& stop : report.stops)
    EXPECT_EQ(stop.validity, SeparationValidity::kMeasured);
  EXPECT_LE(report.pairs.at(0).stop_lower, 0.5 + 1e-6);
  EXPECT_GE(report.pairs[0].stop_lower, 0.5 - 2.0 * 0.07);
}

Scene scara_with_an_eye() {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::finger_urdf());
  return scene_of(
      "name: test\nunits: {length: m, angle: rad}\n"
      "robots: [{name: arm, urdf: scara.urdf, joints: {elbow: {velocity: 2}}, stopping: "
      "{reaction_ms: 40, path: kept, time_ms: 100, joints: {shoulder: {deceleration: 4}}}}]\n"
      "sensors: [{name: eye, points: /cam/points, depth_error: {constant: 0.01}, range: [0.3, 4], "
      "max_speed: 0.1, mount: {pose: {xyz: [0, 0, 2]}}}]\n"
      "pairs: [{between: [arm, eye]}]\n"
      "zones: [{name: stops, between: [arm, eye], stops: {margin: 0.05}}]\n",
      folder / "cell.yaml");
}

// One point of 10 cm on the finger's circle. What it belongs to may move at 0.1 m/s.
TEST(StoppingScaras, CountWhatACameraShows) {
  const Scene scene = scara_with_an_eye();
  const double speed = 1.0, left = 0.1;
  const double time = kReaction + speed / kDeceleration;
  const double at = angle_to_stop(speed) + test::angle_before(left + 0.1 * time);
  const auto eye = static_cast<std::uint32_t>(
      std::ranges::find(scene.objects, "eye", &Object::name) - scene.objects.begin());
  StoppingTicks ticks(scene);
  expect_unknown(ticks.tick(0.0, speed));
  SeenCloud cloud = SeenCloud::of_points(1);
  const std::vector<MeasuredPoint> points = {
      {static_cast<float>(2.0 * std::cos(at)), static_cast<float>(2.0 * std::sin(at)), 0.0F, 0.1F}};
  ASSERT_EQ(cloud.points()->build(points, {Vec3::Zero(), 10.0}), CloudBuild::kBuilt);
  ASSERT_TRUE(ticks.monitor.show(
      scene.objects[eye].sensor,
      {.cloud = &cloud, .stamp_ns = ticks.now + kTick, .world_from_sensor = {}}));
  const Report& report = ticks.tick(0.0, speed);
  EXPECT_LE(report.pairs.at(0).stop_lower, left + 1e-6);
  EXPECT_GE(report.pairs[0].stop_lower, left - test::kStopTolerance - 1e-5);
  EXPECT_EQ(report.stops.at(0).scaling, 1.0);
}

}  // namespace
}  // namespace clearance
