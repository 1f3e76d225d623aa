// Oracles: closed forms of the distances of spheres, and questions about single postures.
#include "monitor/ask/asker.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "core/shapes.hpp"
#include "tests/monitor/ask/scara_questions.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance {
namespace {

constexpr const char* kSheet =
    "fixed: true, box: {size: [0.6, 0.002, 0.4]}, pose: {xyz: [1.9, 0, 0]}";

using test::answered, test::kPin, test::scara_beside, test::swing;

TEST(Asker, FindsTheClosestInstantBetweenWaypoints) {
  const Scene scene = scara_beside(kPin);
  Question question = swing(-1.0, 0.6);
  question.tolerance = 1e-9;
  const Answer answer = answered(scene, question);
  EXPECT_LE(answer.lower, 0.15 + 1e-12);
  EXPECT_GE(answer.lower, 0.15 - 1e-9);
  EXPECT_NEAR(answer.upper, 0.15, 1e-9);
  EXPECT_NEAR(answer.time, 1.25, 1e-3);
  EXPECT_EQ(scene.objects[answer.first].name + scene.objects[answer.second].name, "postfinger");
  EXPECT_EQ(answer.margins[0].verdict, Verdict::kFree);
}

TEST(Asker, TellsAGrazingPassFromAContactByTheMargin) {
  const Scene scene = scara_beside(kPin);
  Question question = swing(-1.0, 0.6);
  question.margins = {0.15 - 1e-8, 0.15 + 1e-8};
  const Answer answer = answered(scene, question);
  EXPECT_EQ(answer.margins[0].verdict, Verdict::kFree);
  ASSERT_EQ(answer.margins[1].verdict, Verdict::kBelow);
  EXPECT_NEAR(answer.margins[1].below_at, 1.25, 1e-3);
}

// The centre is 2.3 - 2 cos(a) and 2 sin(a) from the pin's; 0.5 m less the radii is the margin.
TEST(Asker, LocatesTheFirstInstantBelowAMargin) {
  Question question = swing(-1.0, 0.6);
  question.margins = {0.35};
  const Answer answer = answered(scara_beside(kPin), question);
  const double cosine = (2.3 * 2.3 + 2.0 * 2.0 - 0.5 * 0.5) / (2.0 * 2.3 * 2.0);
  const double truth = 2.0 * (1.0 - std::acos(cosine)) / 1.6;
  ASSERT_EQ(answer.margins[0].verdict, Verdict::kBelow);
  EXPECT_LE(answer.margins[0].above_until, truth + 1e-12);
  EXPECT_GE(answer.margins[0].above_until, truth - 1e-6);
  EXPECT_GE(answer.margins[0].below_at, truth - 1e-12);
  EXPECT_LE(answer.margins[0].below_at, truth + 1e-6);
}

TEST(Asker, SeesAThinSheetThatNoWaypointTouches) {
  const Scene scene = scara_beside(kSheet);
  const Answer answer = answered(scene, swing(-1.0, 1.0));
  EXPECT_EQ(answer.upper, 0.0);
  ASSERT_EQ(answer.margins[0].verdict, Verdict::kBelow);
  EXPECT_EQ(answered(scene, swing(-1.0, -1.0)).margins[0].verdict, Verdict::kFree);
  EXPECT_EQ(answered(scene, swing(1.0, 1.0)).margins[0].verdict, Verdict::kFree);
}

// All joints move, along cubic polynomials, and every posture is asked for by itself.
TEST(Asker, NoPostureOfTheMotionIsNearerThanTheLowerBound) {
  const Scene scene = scara_beside(kPin);
  Question question;
  question.motion = {.joints = {"shoulder", "elbow", "push"},
                     .times = {0.0, 0.7, 2.0},
                     .positions = {-1.0, 0.9, 0.02, 0.1, -0.4, 0.1, 0.8, 0.5, 0.05},
                     .velocities = {0.0, 0.0, 0.0, 1.2, -0.8, 0.05, 0.0, 0.0, 0.0}};
  question.tolerance = 1e-6;
  const Answer answer = answered(scene, question);
  double least = 1e300;
  for (int i = 0; i <= 2000; ++i) {
    const double t = 0.001 * i;
    const int row = t < 0.7 ? 0 : 1;
    const double begin = question.motion.times[row];
    const double length = question.motion.times[row + 1] - begin, u = (t - begin) / length;
    Question posture;
    posture.motion = {
        .joints = question.motion.joints, .times = {0.0}, .positions = {}, .velocities = {}};
    for (int joint = 0; joint < 3; ++joint) {  // in the basis of Hermite
      const auto at = [&](const std::vector<double>& rows, int r) { return rows[3 * r + joint]; };
      posture.motion.positions.push_back(
          at(question.motion.positions, row) * (1 - u) * (1 - u) * (1 + 2 * u) +
          at(question.motion.positions, row + 1) * u * u * (3 - 2 * u) +
          length * at(question.motion.velocities, row) * u * (1 - u) * (1 - u) -
          length * at(question.motion.velocities, row + 1) * u * u * (1 - u));
    }
    least = std::min(least, answered(scene, posture).upper);
  }
  EXPECT_LE(answer.lower, least + 1e-12);
  EXPECT_GE(answer.lower, least - 1e-4);
  EXPECT_LE(answer.upper, least + 1e-6);
}

TEST(Asker, AMovingObjectComesNearerByItsLargestSpeed) {
  const Scene scene = scara_beside("max_speed: 0.05, sphere: {radius: 0.1}");
  Question question = swing(0.0, 0.0);
  question.poses = {{.object = "post", .world_from_object = {.position = {2.3, 0.0, 0.0}}}};
  EXPECT_NEAR(answered(scene, question).lower, 0.15 - 0.05 * 2.0, 1e-3);
  question.poses[0].age = 0.5;
  EXPECT_NEAR(answered(scene, question).lower, 0.15 - 0.05 * 2.5, 1e-3);
  EXPECT_NEAR(answered(scene, question).upper, 0.15 - 0.05 * 2.5, 1e-3);
  question.poses[0].age = -0.5;
  EXPECT_TRUE(std::holds_alternative<std::string>(ask(scene, question)));
  question.poses[0].age = 0.5;
  question.others = OthersMove::kNot;
  EXPECT_NEAR(answered(scene, question).lower, 0.15, 1e-9);
}

TEST(Asker, GivesTheSameBitsWhateverWasAskedBeforeAndAllocatesNothing) {
  const Scene scene = scara_beside(kPin);
  Asker asker(scene);
  Answer first, second, other;
  const Question question = swing(-1.0, 0.6), another = swing(-0.2, 0.9);
  ASSERT_FALSE(asker.ask(question, first));
  ASSERT_FALSE(asker.ask(another, other));
  ASSERT_FALSE(asker.ask(question, second));
  EXPECT_EQ(first.lower, second.lower);
  EXPECT_EQ(first.upper, second.upper);
  EXPECT_EQ(first.time, second.time);
  const std::uint64_t before = allocations();
  ASSERT_FALSE(asker.ask(another, second));
  EXPECT_EQ(allocations(), before);
}

TEST(Asker, RefusesAQuestionThatLeavesAJointOpen) {
  const Scene scene = scara_beside(kPin);
  Question question = swing(0.0, 1.0);
  question.held.pop_back();
  EXPECT_TRUE(std::holds_alternative<std::string>(ask(scene, question)));
  question = swing(0.0, 1.0);
  question.motion.times = {1.0, 1.0};  // at two places at one time
  EXPECT_TRUE(std::holds_alternative<std::string>(ask(scene, question)));
}

// Degrees that were meant as radians would be another posture; joint states are judged alike.
TEST(Asker, RefusesPositionsBeyondTheLimitsOfAnyJoint) {
  const Scene scene = scara_beside(kPin);
  const auto is_refused = [&](const Question& question) {
    return std::holds_alternative<std::string>(ask(scene, question));
  };
  EXPECT_TRUE(is_refused(swing(0.0, 30.0)));
  EXPECT_TRUE(is_refused(swing(-30.0, 0.0)));
  EXPECT_FALSE(is_refused(swing(-3.0, 3.0)));
  Question question = swing(0.0, 30.0);
  question.motion.joints = {"elbow"};  // a continuous one
  question.held[0] = {"shoulder", 50.0};
  EXPECT_TRUE(is_refused(question));
  question.held[0].position = 3.01;  // as far beyond as encoders are off
  EXPECT_FALSE(is_refused(question));
}

TEST(Asker, TakesAWaypointThatIsStatedTwice) {
  const Scene scene = scara_beside(kPin);
  Question question = swing(-1.0, 0.6);
  const Answer once = answered(scene, question);
  question.motion.times = {0.0, 0.0, 2.0, 2.0};
  question.motion.positions = {-1.0, -1.0, 0.6, 0.6};
  EXPECT_EQ(answered(scene, question).lower, once.lower);
}

// The jerk of the first steps is more than a double holds. Its bounds were no numbers once, and the
// pin was free.
TEST(Asker, RefusesAStepTooShortForItsCubicAndBoundsOneThatIsLonger) {
  const Scene scene = scara_beside(kPin);
  for (const double step : {5e-324, 1e-110, 1e-103, 1e-21, 1e-20, 1e-19, 1e-12}) {
    for (const bool is_cubic : {true, false}) {
      Question question = swing(0.0, 1.0);
      question.motion.times = {0.0, step, 1.0};
      question.motion.positions = {0.0, 1.0, 2.0};
      if (is_cubic) question.motion.velocities = {0.0, 0.0, 0.0};
      question.margins_between = {{"arm", "post", 3.0}};
      const auto found = ask(scene, question);
      ASSERT_EQ(std::holds_alternative<std::string>(found), step < 1e-20) << step;
      if (step < 1e-20) {
        EXPECT_NE(std::get<std::string>(found).find("waypoint 1 is less than 1e-20 s after"),
                  std::string::npos);
        continue;
      }
      const Answer& answer = std::get<Answer>(found);
      EXPECT_LE(answer.lower, 0.15 + 1e-9) << "at its first waypoint";
      EXPECT_EQ(answer.margins.back().verdict, Verdict::kBelow) << step;
    }
  }
}

TEST(Asker, OnlyVerdictsAreThoseOfTheWholeAnswer) {
  const Scene scene = scara_beside(kPin);
  for (const double margin : {0.0, 0.1, 0.149, 0.151, 0.3}) {
    Question question = swing(-1.0, 0.6);
    question.margins = {margin};
    const Answer whole = answered(scene, question);
    question.only_margins = question.only_verdicts = true;
    const Answer verdict = answered(scene, question);
    EXPECT_EQ(verdict.margins[0].verdict, whole.margins[0].verdict) << margin;
    EXPECT_LE(verdict.lower, whole.upper);
  }
}

TEST(Asker, KeepsItsBoundsWhenTheWorkEndsEarly) {
  Question question = swing(-1.0, 0.6);
  question.work_limit = 1;
  const Answer answer = answered(scara_beside(kPin), question);
  EXPECT_FALSE(answer.within_work_limit);
  EXPECT_LE(answer.lower, 0.15);
  EXPECT_GE(answer.upper, 0.15 - 1e-12);
  EXPECT_NE(answer.margins[0].verdict, Verdict::kBelow);
}

// Half of the questions have faults or payloads, so that threads meet in all states.
TEST(Asker, AnswersOfManyQuestionsHaveTheSameBitsForAnyNumberOfThreads) {
  const Scene scene = scara_beside(kPin);
  std::vector<Question> questions;
  for (int i = 0; i < 60; ++i) {
    Question question = swing(-1.0 + 0.03 * i, 0.6 - 0.02 * i);
    question.margins = {0.0, 0.01 * i};
    if (i % 7 == 3) question.held.pop_back();
    if (i % 5 == 2) question.profile = ProfileRequest{};
    if (i % 4 == 1)
      question.payloads = {{.name = "part",
                            .shape = std::get<ConvexBody>(box({0.05, 0.05, 0.05})),
                            .link = "finger",
                            .link_from_object = {.position = {0.1, 0, 0}},
                            .touch = {}}};
    questions.push_back(std::move(question));
  }
  const auto all = [&](unsigned threads) {
    std::vector<Answer> answers(questions.size());
    std::vector<std::string> faults(questions.size());
    ask_all(scene, questions, answers, faults, threads);
    return std::pair(std::move(answers), std::move(faults));
  };
  const auto [one, faults_of_one] = all(1);
  for (const unsigned threads : {0u, 2u, 3u, 8u, 100u}) {
    const auto [several, faults] = all(threads);
    ASSERT_EQ(faults, faults_of_one) << threads;
    for (std::size_t i = 0; i < questions.size(); ++i) {
      const Answer &a = one[i], &b = several[i];
      EXPECT_EQ(std::tie(a.lower, a.upper, a.time, a.first, a.second, a.queries, a.placements),
                std::tie(b.lower, b.upper, b.time, b.first, b.second, b.queries, b.placements))
          << i << " in " << threads;
      ASSERT_EQ(a.margins.size(), b.margins.size());
      for (std::size_t m = 0; m < a.margins.size(); ++m) {
        EXPECT_EQ(std::tie(a.margins[m].verdict, a.margins[m].above_until, a.margins[m].below_at),
                  std::tie(b.margins[m].verdict, b.margins[m].above_until, b.margins[m].below_at));
      }
      ASSERT_EQ(a.profile.size(), b.profile.size());
    }
  }
  EXPECT_NE(faults_of_one[3], "");
  EXPECT_EQ(faults_of_one[4], "");
}

// No posture takes the finger farther than 1.3 m from the upper link. It is 1.25 m away here, and
// 0.15 m from the post.
TEST(Asker, AMarginCountsForNoPairThatTheBuildKeepsNearerInEveryPosture) {
  const Scene scene = test::scara_beside(
      "fixed: true, sphere: {radius: 0.1}, pose: {xyz: [2.5, 0, 0]}",
      "zones: [{name: stop, between: [post, finger], enter_below: 0, leave_above: 0}]\n");
  Question question = test::swing(0.0, 0.0);
  question.held = {{"elbow", 0.0}, {"push", 0.2}};
  question.margins = {0.15, 0.14, 0.19, 1.24};
  question.margins_between = {
      {"upper", "finger", 1.24}, {"upper", "finger", 1.26}, {"stop", "", 0.14}, {"stop", "", 0.16}};
  for (const bool only : {false, true}) {
    question.only_margins = question.only_verdicts = only;
    const Answer answer = test::answered(scene, question);
    ASSERT_EQ(answer.margins.size(), 8u);
    EXPECT_EQ(answer.margins[1].verdict, Verdict::kFree);
    for (const std::size_t i : {2u, 3u}) {
      ASSERT_EQ(answer.margins[i].verdict, Verdict::kBelow) << i;
      EXPECT_EQ(scene.objects[answer.margins[i].first].name, "post") << i;
    }
    EXPECT_EQ(answer.margins[4].verdict, Verdict::kFree);
    EXPECT_EQ(answer.margins[5].verdict, Verdict::kBelow);
    EXPECT_EQ(answer.margins[6].verdict, Verdict::kFree);
    EXPECT_EQ(answer.margins[7].verdict, Verdict::kBelow);
  }
  question.poses = {};
  question.margins_between = {{"upper", "nothing", 0.1}};
  EXPECT_TRUE(std::holds_alternative<std::string>(ask(scene, question)));
  const Scene far =
      test::scara_beside("fixed: true, sphere: {radius: 0.1}, pose: {xyz: [9, 0, 0]}");
  question.margins_between.clear();
  question.margins = {1.4};
  EXPECT_EQ(test::answered(far, question).margins[0].verdict, Verdict::kFree);
}

}  // namespace
}  // namespace clearance
