// Motions whose robot may be told to stop at any instant. Oracles: closed forms for one joint.
#include <cmath>
#include <string>

#include "tests/monitor/ask/scara_questions.hpp"
#include "tests/monitor/ask/stopping_scara.hpp"
#include "tests/shared/allocation_count.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance {
namespace {

using test::answered;
using test::scene_of_scara;

constexpr double kUntilBrakes = 0.04;  // s: a stop begins when the robot is told, not with a report

// The shoulder rotates by an angle at a constant speed.
Question turning(double angle, double speed) {
  Question question = test::swing(0.0, angle);
  question.motion.times = {0.0, angle / speed};
  question.stoppable = true;
  return question;
}

// The same from rest to rest.
Question turning_to_rest(double angle, double time) {
  Question question = test::swing(0.0, angle);
  question.motion.times = {0.0, time};
  question.motion.velocities = {0.0, 0.0};
  question.stoppable = true;
  return question;
}

double angle_of_stop(double speed) {
  return speed * kUntilBrakes + 0.5 * speed * speed / test::kDeceleration;
}

// A box counts by its half times the largest distance from the axis, which the finger's radius
// adds to, and not along its circle.
double looseness(const std::string& path, double speed) {
  return 1.1e-3 + (path == test::kLeft ? 0.15 * 0.25 * speed * speed / test::kDeceleration : 0.0);
}

void expect_verdicts_about(double distance, double looseness, const Scene& scene,
                           Question question) {
  question.margins = {distance - looseness, distance + 1e-3};
  const Answer answer = answered(scene, question);
  EXPECT_EQ(answer.margins.at(0).verdict, Verdict::kFree);
  EXPECT_EQ(answer.margins.at(1).verdict, Verdict::kBelow);
}

TEST(StoppableMotions, GoOnPastAGoalThatTheyDoNotReachAtRest) {
  Random random(61);
  for (std::uint64_t i = 0; i < repeats(40); ++i) {
    const double angle = random.uniform(0.1, 0.8), speed = random.uniform(0.2, 2.0);
    const double left = random.uniform(0.05, 0.2);
    const double at = angle + angle_of_stop(speed) + test::angle_before(left);
    for (const std::string& path : {test::kKept, test::kLeft}) {
      const Scene scene = scene_of_scara({.path = path, .at = at});
      const Question question = turning(angle, speed);
      const Answer answer = answered(scene, question);
      EXPECT_LE(answer.lower, left + 1e-9);
      EXPECT_GE(answer.lower, left - looseness(path, speed)) << path;
      expect_verdicts_about(left, looseness(path, speed), scene, question);
    }
  }
}

// Nothing else moves, so the path is all that is to be examined.
TEST(StoppableMotions, ThatKeepTheirPathToAGoalAtRestHaveTheAnswerOfTheMotion) {
  Random random(62);
  for (std::uint64_t i = 0; i < repeats(40); ++i) {
    const Scene scene = scene_of_scara({.at = random.uniform(0.3, 1.2)});
    Question question = turning_to_rest(random.uniform(0.1, 0.8), random.uniform(0.3, 2.0));
    question.margins = {0.0, 0.05, 0.2};
    question.profile.emplace();
    const Answer with = answered(scene, question);
    question.stoppable = false;
    const Answer without = answered(scene, question);
    EXPECT_EQ(with.lower, without.lower);
    EXPECT_EQ(with.upper, without.upper);
    EXPECT_EQ(with.queries, without.queries);
    ASSERT_EQ(with.profile.size(), without.profile.size());
    for (std::size_t m = 0; m < 3; ++m)
      EXPECT_EQ(with.margins[m].verdict, without.margins[m].verdict);
  }
}

// The farthest that the shoulder comes in any stop that leaves the path.
double farthest(double angle, double time) {
  double most = 0.0;
  for (int i = 0; i <= 20'000; ++i) {
    const double u = i / 20'000.0;
    const double speed = angle / time * 6.0 * u * (1.0 - u);
    most =
        std::max(most, angle * u * u * (3.0 - 2.0 * u) + 0.5 * speed * speed / test::kDeceleration);
  }
  return most;
}

TEST(StoppableMotions, ThatLeaveTheirPathCountEachJointAsFarAsItsSpeedTakesIt) {
  Random random(63);
  for (std::uint64_t i = 0; i < repeats(40); ++i) {
    const double angle = random.uniform(0.2, 0.8), time = random.uniform(0.8, 1.5);
    const double left = random.uniform(0.05, 0.2);
    const double at = farthest(angle, time) + test::angle_before(left);
    const Scene scene = scene_of_scara({.path = test::kLeft, .at = at});
    const Answer answer = answered(scene, turning_to_rest(angle, time));
    EXPECT_LE(answer.lower, left + 1e-9);
    // The largest speed of a part of the motion counts in all of it.
    EXPECT_GE(answer.lower,
              std::max(0.0, left - 0.01 - looseness(test::kLeft, 1.5 * angle / time)));
  }
}

TEST(StoppableMotions, ThatLeaveWhatIsBehindThemAreFree) {
  for (const std::string& path : {test::kKept, test::kLeft}) {
    const Scene scene = scene_of_scara({.path = path, .at = -test::angle_before(0.02)});
    Question question = turning(0.8, 1.0);
    question.margins = {path == test::kKept ? 0.0199 : 0.015};
    EXPECT_EQ(answered(scene, question).margins.at(0).verdict, Verdict::kFree) << path;
  }
}

// Until the robot stands, the ball moves by its largest speed.
TEST(StoppableMotions, AreNearerToWhatMovesUntilTheRobotStands) {
  const double ball = 0.1, angle = 0.5, speed = 1.0, left = 0.1;
  const double stands = angle / speed + kUntilBrakes + speed / test::kDeceleration;
  const double at = angle + angle_of_stop(speed) + test::angle_before(left + ball * stands);
  const Scene scene = scene_of_scara({.ball = "max_speed: 0.1, may_jump: true, "});
  Question question = turning(angle, speed);
  question.poses = {
      {.object = "ball", .world_from_object = test::at(2.0 * std::cos(at), 2.0 * std::sin(at), 0)}};
  const Answer answer = answered(scene, question);
  EXPECT_LE(answer.lower, left + 1e-9);
  EXPECT_GE(answer.lower, left - 1.1e-3);
  question.stoppable = false;
  EXPECT_GT(answered(scene, question).lower, left + 0.1);
}

// Beside a ball that moves at 0.1 m/s, and `left` from the goal.
void expect_left_after(double seconds, const test::StoppingScara& cell, Question question) {
  const double left = 0.2, goal = question.motion.positions.back();
  const double at = goal + test::angle_before(left);
  test::StoppingScara beside = cell;
  beside.ball = "max_speed: 0.1, may_jump: true, ";
  question.poses = {
      {.object = "ball", .world_from_object = test::at(2.0 * std::cos(at), 2.0 * std::sin(at), 0)}};
  const Answer answer = answered(scene_of_scara(beside), question);
  EXPECT_LE(answer.lower, left - 0.1 * seconds + 1e-9);
  EXPECT_GE(answer.lower, left - 0.1 * seconds - 1.1e-3);
}

// The shoulder brakes for 0.25 s from each of its speeds.
TEST(StoppableMotions, AreAtTheirGoalAsLongAsAStopTakesThatBeginsJustBefore) {
  expect_left_after(0.5 + 0.25, {.shoulder = "time_ms: 250"}, turning_to_rest(0.4, 0.5));
}

// A stop that begins at 2 rad/s takes 0.5 s and reaches the goal, which the motion reaches slowly.
TEST(StoppableMotions, AreAtAPlaceAsLongAsAStopTakesThatBeganBeforeIt) {
  Question question = turning(0.0, 1.0);
  question.motion.times = {0.0, 0.2, 0.4, 0.41};
  question.motion.positions = {0.0, 0.4, 0.42, 0.42};
  expect_left_after(0.2 + 0.5, {}, question);
}

// A contact that time ends: the robot leaves the ball before that, but not if it is told to stop.
TEST(StoppableMotions, AreNoLongerInAContactThatEndsBeforeTheyStand) {
  const Scene scene = scene_of_scara({.at = -test::angle_before(-0.01)});
  Question question = turning(0.5, 0.5);
  question.contacts = {{.first = "finger", .second = "ball", .depth = 0.02, .until = 0.05}};
  question.stoppable = false;
  EXPECT_EQ(answered(scene, question).margins.at(0).verdict, Verdict::kFree);
  question.stoppable = true;
  EXPECT_EQ(answered(scene, question).margins.at(0).verdict, Verdict::kBelow);
  question.contacts->front().until = 0.5;
  EXPECT_EQ(answered(scene, question).margins.at(0).verdict, Verdict::kFree);
}

TEST(StoppableMotions, OfOneWaypointCountTheVelocityThatItStates) {
  const double speed = 1.5, left = 0.1;
  for (const std::string& path : {test::kKept, test::kLeft}) {
    const Scene scene =
        scene_of_scara({.path = path, .at = angle_of_stop(speed) + test::angle_before(left)});
    Question question = test::swing(0.0, 0.0);
    question.motion.times = {0.0};
    question.motion.positions = {0.0};
    question.motion.velocities = {speed};
    question.stoppable = true;
    expect_verdicts_about(left, looseness(path, speed), scene, question);
    question.motion.velocities = {-speed};
    question.margins = {left + 0.1};
    EXPECT_EQ(answered(scene, question).margins.at(0).verdict, Verdict::kFree);
  }
}

// What slides stops at its limits at the latest.
TEST(StoppableMotions, ThatSlideCountTheirLimits) {
  const Scene scene = scene_of_scara({.at = 3.0});
  const JointVariable& push =
      *std::ranges::find(scene.variables, std::string("push"), &JointVariable::name);
  Question question = test::swing(0.0, 0.0);
  question.motion = {.joints = {"push"},
                     .times = {0.0, 0.1},
                     .positions = {push.upper - 0.05, push.upper - 0.001},
                     .velocities = {}};
  question.held = {{"elbow", 0.0}, {"shoulder", 0.0}};
  question.stoppable = true;
  const Answer answer = answered(scene, question);
  EXPECT_TRUE(answer.within_work_limit);
  EXPECT_GT(answer.lower, 1.0);
}

TEST(StoppableMotions, AreTimedSlowerUntilTheirStopsKeepTheMargin) {
  Random random(64);
  for (std::uint64_t i = 0; i < repeats(40); ++i) {
    const double angle = random.uniform(0.1, 0.8), speed = random.uniform(0.5, 2.0);
    const double share = random.uniform(0.2, 0.95), margin = 0.05;
    const double at = angle + angle_of_stop(share * speed) + test::angle_before(margin);
    for (const std::string& path : {test::kKept, test::kLeft}) {
      const Scene scene = scene_of_scara({.path = path, .at = at});
      Question question = turning(angle, speed);
      question.margins = {margin};
      question.time_scaling = true;
      const TimeScaling scaling = answered(scene, question).scaling;
      EXPECT_TRUE(scaling.is_limited);
      EXPECT_LE(scaling.factor, share + 1e-9);
      EXPECT_GE(scaling.factor, share - (path == test::kKept ? 0.011 : 0.03)) << path;
      EXPECT_GE(scaling.factor_above, scaling.factor);
      EXPECT_EQ(scaling.zone, TimeScaling::kNoZone);
      // A question about the slower motion confirms it.
      Question slower = turning(angle, scaling.factor * speed);
      slower.margins = {margin};
      EXPECT_EQ(answered(scene, slower).margins.at(0).verdict, Verdict::kFree);
    }
  }
}

// The ball is where the question has it when the robot is told, and moves from then on.
TEST(StoppableMotions, AreTimedSlowerForWhatMovesUntilTheyStand) {
  const double angle = 0.5, speed = 2.0, share = 0.6, margin = 0.05;
  const double stands = kUntilBrakes + share * speed / test::kDeceleration;
  const double at =
      angle + angle_of_stop(share * speed) + test::angle_before(margin + 0.1 * stands);
  const Scene scene = scene_of_scara({.ball = "max_speed: 0.1, may_jump: true, "});
  Question question = turning(angle, speed);
  question.margins = {margin};
  question.time_scaling = true;
  question.poses = {
      {.object = "ball", .world_from_object = test::at(2.0 * std::cos(at), 2.0 * std::sin(at), 0)}};
  const TimeScaling scaling = answered(scene, question).scaling;
  EXPECT_LE(scaling.factor, share + 1e-9);
  EXPECT_GE(scaling.factor, share - 0.011);
}

TEST(StoppableMotions, AreNotTimedAtAllIfTheirPathIsTooNear) {
  const Scene scene = scene_of_scara({.at = 0.5});
  Question question = turning(0.5, 1.0);
  question.time_scaling = true;
  EXPECT_EQ(answered(scene, question).scaling.factor, 0.0);
}

TEST(StoppableMotions, AreNotTimedFaster) {
  const Scene scene = scene_of_scara({.at = 3.0});
  Question question = turning(0.5, 1.0);
  question.time_scaling = true;
  EXPECT_EQ(answered(scene, question).scaling.factor, 1.0);
}

TEST(StoppableMotions, GetTheSameBitsWhateverWasAskedBeforeAndAllocateNothing) {
  const Scene scene = scene_of_scara({.path = test::kLeft, .at = 1.0});
  Asker asker(scene);
  Answer first, second, other;
  Question question = turning(0.5, 2.0), another = turning_to_rest(0.7, 0.6);
  question.margins = another.margins = {0.0, 0.1};
  question.time_scaling = another.time_scaling = true;
  ASSERT_FALSE(asker.ask(question, first));
  ASSERT_FALSE(asker.ask(another, other));
  ASSERT_FALSE(asker.ask(question, second));
  EXPECT_EQ(first.lower, second.lower);
  EXPECT_EQ(first.upper, second.upper);
  EXPECT_EQ(first.scaling.factor, second.scaling.factor);
  const std::uint64_t before = allocations();
  ASSERT_FALSE(asker.ask(another, second));
  ASSERT_FALSE(asker.ask(question, second));
  EXPECT_EQ(allocations(), before);
}

std::string refusal(const Scene& scene, const Question& question) {
  const std::variant<Answer, std::string> answer = ask(scene, question);
  const auto* text = std::get_if<std::string>(&answer);
  return text == nullptr ? "" : *text;
}

TEST(StoppableMotions, AreRefusedUnlessTheRobotStatesHowItStops) {
  const Scene scene = test::scara_beside(test::kPin);
  Question question = turning(0.5, 1.0);
  EXPECT_NE(refusal(scene, question).find("robot \"arm\" states no stopping"), std::string::npos);
  question.stoppable = false;
  EXPECT_EQ(refusal(scene, question), "");
}

TEST(StoppableMotions, AreRefusedBesideOtherMotionsThatAreStated) {
  const Scene scene = scene_of_scara({.ball = "max_speed: 0.1, may_jump: true, "});
  Question question = turning(0.5, 1.0);
  question.moving = {{.object = "ball", .times = {0.0}, .world_from_object = {test::at(9, 0, 0)}}};
  EXPECT_NE(refusal(scene, question).find("no motions in beside or moving"), std::string::npos);
  question.moving.clear();
  question.beside = {{.joints = {"elbow"}, .times = {0.0}, .positions = {0.0}, .velocities = {}}};
  question.held = {{"push", 0.0}};
  EXPECT_NE(refusal(scene, question).find("no motions in beside or moving"), std::string::npos);
}

// Two arms whose fingers come towards each other, each as the other's picture in a mirror.
// `stands`: the angle of both shoulders at which the fingers are `left` apart.
Scene mirrored_arms(const std::string& path, double stands, double left,
                    const std::string& of_right) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::finger_urdf());
  const auto robot = [](const std::string& name, const std::string& rest) {
    return "  - {name: " + name + ", urdf: scara.urdf, prefix: " + name +
           "_, joints: {elbow: {velocity: 2}}" + rest + "}\n";
  };
  const std::string stopping = ", stopping: {reaction_ms: 40, " + path +
                               ", time_ms: 100, joints: {shoulder: {deceleration: 4}}}";
  const double apart = 4.0 * std::cos(stands) + 0.1 + left;
  return scene_of("name: test\nunits: {length: m, angle: rad}\nrobots:\n" +
                      robot("left", stopping) +
                      robot("right", ", base: {pose: {xyz: [" + std::to_string(apart) +
                                         ", 0, 0], rpy: [0, 0, 3.14159265358979]}}" +
                                         (of_right.empty() ? stopping : of_right)) +
                      "pairs: [{between: [left, right]}]\n",
                  folder / "cell.yaml");
}

Question both_turning(double from, double angle, double speed) {
  Question question;
  question.motion = {.joints = {"left_shoulder", "right_shoulder"},
                     .times = {0.0, angle / speed},
                     .positions = {from, -from, from - angle, angle - from},
                     .velocities = {}};
  for (const std::string arm : {"left", "right"})
    for (const std::string joint : {"_elbow", "_push"}) question.held.push_back({arm + joint, 0.0});
  question.stoppable = true;
  return question;
}

// Both are told at the same instant, and go on as far as one that stops alone.
TEST(StoppableMotions, OfTwoRobotsGoOnForBoth) {
  Random random(65);
  for (std::uint64_t i = 0; i < repeats(20); ++i) {
    const double angle = random.uniform(0.1, 0.5), speed = random.uniform(0.2, 1.0);
    const double left = random.uniform(0.05, 0.2), stands = random.uniform(1.5, 1.6);
    const Question question = both_turning(stands + angle_of_stop(speed) + angle, angle, speed);
    for (const std::string& path : {test::kKept, test::kLeft}) {
      const Scene scene = mirrored_arms(path, stands, left, "");
      const Answer answer = answered(scene, question);
      EXPECT_LE(answer.lower, left + 1e-9);
      // Boxes count along the largest lever of both fingers, and not along their circles.
      EXPECT_GE(answer.lower, left - 1.1e-3 - 0.15 * angle_of_stop(speed)) << path;
    }
  }
}

TEST(StoppableMotions, OfTwoRobotsNameTheOneThatDoesNotStateHowItStops) {
  const Scene scene = mirrored_arms(test::kKept, 1.6, 0.1, ", age_limit_ms: 100");
  EXPECT_NE(refusal(scene, both_turning(2.0, 0.2, 1.0)).find("robot \"right\" states no stopping"),
            std::string::npos);
}

}  // namespace
}  // namespace clearance
