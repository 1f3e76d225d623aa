// Stops at the limits of what a question, a joint or a cell can state. Oracles: closed forms for
// the robot of stopping_scara.hpp.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "monitor/ask/stopping_joints.hpp"
#include "monitor/clouds/seen_cloud.hpp"
#include "tests/monitor/ask/scara_questions.hpp"
#include "tests/monitor/ask/stopping_scara.hpp"

namespace clearance {
namespace {

using test::kTick, test::StoppingTicks;

// The shoulder moves between these times, and is as fast as this at the end.
Question between(double begin, double end, double speed) {
  Question question = test::swing(0.0, 0.0);
  question.motion.times = {begin, end};
  question.motion.velocities = {0.0, speed};
  question.stoppable = true;
  return question;
}

// The middle of two neighbouring numbers is one of them. Once, the motion was divided there without
// end.
TEST(StopsAtLimits, OfMotionsAsShortAsTimesCanTellAreAnswered) {
  const Scene scene = test::scene_of_scara({.at = 3.0});
  double begin = 1.0;
  for (int i = 0; i < 4; ++i) {
    const double end = std::nextafter(begin, 2.0);
    EXPECT_GT(test::answered(scene, between(begin, end, 1e-3)).lower, 3.0);
    begin = end;
  }
}

TEST(StopsAtLimits, OfOneWaypointAtRestStayThere) {
  const double left = 0.1;
  const Scene scene = test::scene_of_scara({.at = test::angle_before(left)});
  Question question = test::swing(0.0, 0.0);
  question.stoppable = true;
  question.motion.times = {0.0};
  question.motion.positions = {0.0};
  for (const std::vector<double>& velocities : {std::vector<double>(), {0.0}}) {
    question.motion.velocities = velocities;
    const Answer answer = test::answered(scene, question);
    EXPECT_LE(answer.lower, left + 1e-9);
    EXPECT_GE(answer.lower, left - 1.1e-3);
  }
}

// The base of this arm follows a frame. What carries it has no brakes of its own.
Scene scara_on_a_frame(const std::string& robots, const std::string& pairs) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::finger_urdf());
  return scene_of(
      "name: test\nunits: {length: m, angle: rad}\nros2: {world_frame: map}\nrobots:\n"
      "  - {name: arm, urdf: scara.urdf, joints: {elbow: {velocity: 2}}, base: {frame: cart, "
      "max_speed: 0.1, max_turn_speed: 0.1}, stopping: {reaction_ms: 40, time_ms: 100}}\n" +
          robots +
          "objects:\n  - {name: ball, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [0, 4, "
          "0]}}\npairs:\n  - {between: [arm, ball]}\n" +
          pairs,
      folder / "cell.yaml");
}

TEST(StopsAtLimits, OfWhatCarriesARobotAreNotKnown) {
  const Scene scene = scara_on_a_frame("", "");
  Question question;
  question.motion = {.joints = {"arm_base/trans_x"},
                     .times = {0.0, 1.0},
                     .positions = {0.0, 1.0},
                     .velocities = {}};
  question.stoppable = true;
  for (const JointVariable& variable : scene.variables)
    if (variable.name != "arm_base/trans_x")
      question.held.push_back({variable.name, variable.name.ends_with("rot_w") ? 1.0 : 0.0});
  const std::variant<Answer, std::string> answer = ask(scene, question);
  ASSERT_TRUE(std::holds_alternative<std::string>(answer));
  EXPECT_NE(std::get<std::string>(answer).find("\"arm_base/trans_x\" has no stop"),
            std::string::npos)
      << std::get<std::string>(answer);
}

// The arm on the frame stops as well, and what carries it goes on.
TEST(StopsAtLimits, BesideAnArmOnAFrameAreKnown) {
  const Scene scene = scara_on_a_frame(
      "  - {name: right, urdf: scara.urdf, prefix: right_, joints: {elbow: {velocity: 2}}, base: "
      "{pose: {xyz: [5, 0, 0], rpy: [0, 0, 3.141592653589793]}}, stopping: {reaction_ms: 40, "
      "time_ms: 100}}\n",
      "  - {between: [arm, right]}\n");
  Monitor monitor(scene);
  std::vector<JointSample> said;
  for (std::uint32_t v = 0; v < scene.variables.size(); ++v) {
    const bool is_one = scene.variables[v].name.ends_with("rot_w");
    said.push_back(test::joint(v, is_one ? 1.0 : 0.0, test::kStart));
    said.back().has_velocity = true;
  }
  const Report& report = monitor.tick({}, said, test::kStart);
  ASSERT_EQ(report.stops.size(), 2u);
  for (const RobotStop& stop : report.stops)
    EXPECT_NE(stop.validity, SeparationValidity::kUnknown) << stop.robot;
}

// No question has a joint beyond 1e6 rad, and the elbow would come there while it stops.
TEST(StopsAtLimits, BeyondThePositionsOfAQuestionAreUnknown) {
  for (const bool is_beyond : {false, true}) {
    StoppingTicks ticks(test::scene_of_scara({.at = 0.2, .margin = 5.0}));
    ticks.now += kTick;
    auto said = test::joints(0.0, is_beyond ? 1e6 - 1e-3 : 0.0, 0.0, ticks.now);
    for (JointSample& joint : said) joint.has_velocity = true;
    said[1].velocity = 1.0;
    const RobotStop& stop = ticks.monitor.tick({}, said, ticks.now).stops.at(0);
    EXPECT_EQ(stop.validity,
              is_beyond ? SeparationValidity::kUnknown : SeparationValidity::kMeasured);
    EXPECT_EQ(stop.clearance == -kInfinity, is_beyond);
  }
}

// The elbow has no limit of its speed that could stand for a velocity that is not known.
TEST(StopsAtLimits, OfAJointThatMayBeAsFastAsEverAreUnknownUntilItsVelocityIs) {
  Scene scene = test::scene_of_scara({.at = 3.0});
  scene.variables[1].max_speed = kInfinity;
  Monitor monitor(scene);
  for (const bool is_told : {false, true}) {
    const std::int64_t now = test::kStart + (is_told ? kTick : 0);
    auto said = test::joints(0.0, 0.0, 0.0, now);
    for (JointSample& joint : said) joint.has_velocity = is_told || joint.variable != 1;
    const RobotStop& stop = monitor.tick({}, said, now).stops.at(0);
    EXPECT_EQ(stop.validity,
              is_told ? SeparationValidity::kMeasured : SeparationValidity::kUnknown);
    EXPECT_EQ(stop.scaling, is_told ? 1.0 : 0.0);
  }
}

// Until the brakes act, the shoulder keeps its velocity v. Then it needs v^2 / (2 d).
TEST(StopsAtLimits, EndWhereTheVelocityAndThenTheBrakesLead) {
  for (const std::string& path : {test::kKept, test::kLeft}) {
    const Scene scene = test::scene_of_scara({.path = path});
    JointTrajectory motion;
    StoppingJoints joints(scene, 0, motion);
    for (const double velocity : {-1.0, 0.0, 0.5}) {
      auto said = test::joints(0.25, 0.0, 0.0, test::kStart);
      for (JointSample& joint : said) joint.has_velocity = true;
      said[0].velocity = velocity;
      Inputs inputs = initial_inputs(scene);
      ingest({}, said, TickTime{test::kStart}, scene, inputs);
      joints.read(inputs);
      const double until_braking = velocity * test::kReaction;
      const double braking = velocity * std::abs(velocity) / (2.0 * test::kDeceleration);
      EXPECT_NEAR(joints.standstill(0), 0.25 + until_braking + braking, 1e-9) << path << velocity;
      EXPECT_NEAR(joints.standstill(1), 0.0, 1e-9);
    }
  }
}

// Whether a pair has the ball first or second.
TEST(StopsAtLimits, BesideWhatIsAbsentAreTheSameInBothOrdersOfAPair) {
  for (const bool is_second : {false, true}) {
    Scene scene = test::scene_of_scara({.ball = "max_speed: 0.1, may_jump: true, "});
    if (is_second)
      for (ObjectPair& pair : scene.pairs) std::swap(pair.first, pair.second);
    StoppingTicks ticks(scene);
    ASSERT_TRUE(ticks.monitor.set_absent(0, true));
    const Report& report = ticks.tick(0.0, 2.0);
    EXPECT_EQ(report.stops.at(0).scaling, 1.0);
    EXPECT_TRUE(std::isnan(report.pairs.at(0).stop_lower));
  }
}

// After a minute without a picture, the camera shows nothing any more. No pair of the arm has it.
TEST(StopsAtLimits, BesideACameraOfOtherPairsThatShowsNothingAnyMoreAreKnown) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::finger_urdf());
  const Scene scene = scene_of(
      "name: test\nunits: {length: m, angle: rad}\n"
      "robots: [{name: arm, urdf: scara.urdf, joints: {elbow: {velocity: 2}}, stopping: "
      "{reaction_ms: 40, time_ms: 100}}]\n"
      "sensors: [{name: eye, points: /cam/points, depth_error: {constant: 0.01}, range: [0.3, 4], "
      "max_speed: 0.1, mount: {pose: {xyz: [0, 0, 2]}}}]\n"
      "objects:\n  - {name: ball, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [0, 4, 0]}}\n"
      "  - {name: cart, max_speed: 0.1, may_jump: true, sphere: {radius: 0.1}}\n"
      "pairs: [{between: [arm, ball]}, {between: [cart, eye]}]\n",
      folder / "cell.yaml");
  StoppingTicks ticks(scene);
  SeenCloud cloud = SeenCloud::of_points(1);
  const std::vector<MeasuredPoint> points = {{1.0F, 0.0F, 0.0F, 0.1F}};
  ASSERT_EQ(cloud.points()->build(points, {Vec3::Zero(), 10.0}), CloudBuild::kBuilt);
  ASSERT_TRUE(ticks.monitor.show(
      0, {.cloud = &cloud, .stamp_ns = ticks.now + kTick, .world_from_sensor = {}}));
  for (const std::int64_t later : {std::int64_t{0}, std::int64_t{200'000'000'000}}) {
    ticks.now += later;
    const RobotStop& stop = ticks.tick(0.0, 0.0).stops.at(0);
    EXPECT_EQ(stop.validity, SeparationValidity::kMeasured) << later;
    EXPECT_EQ(stop.scaling, 1.0) << later;
    EXPECT_EQ(ticks.monitor.uses(&cloud), later == 0);
  }
}

}  // namespace
}  // namespace clearance
