// Oracles: closed forms of the distances of spheres, and the same question in other words.
#include <cmath>

#include "tests/monitor/ask/scara_questions.hpp"

namespace clearance {
namespace {

using test::answered, test::kPin, test::scara_beside, test::swing;

constexpr const char* kBall = "max_speed: 1, sphere: {radius: 0.1}";

TEST(MotionsOfOthers, AnObjectPassesTheRestingFinger) {
  Question question = swing(0.0, 0.0);
  question.tolerance = 1e-6;
  question.moving = {
      {.object = "post",
       .times = {0.5, 1.5},
       .world_from_object = {{.position = {2.4, -1.0, 0.0}}, {.position = {2.4, 1.0, 0.0}}}}};
  const Answer answer = answered(scara_beside(kBall), question);
  EXPECT_NEAR(answer.lower, 0.25, 1e-6);
  EXPECT_NEAR(answer.upper, 0.25, 1e-6);
  EXPECT_NEAR(answer.time, 1.0, 1e-2);
}

// The finger at 2 m and the object at 2.4 m around the origin keep their distance.
TEST(MotionsOfOthers, AnObjectRotatesWithTheRobot) {
  Question question = swing(0.0, 1.0);
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(1.0, Vec3::UnitZ()));
  question.moving = {
      {.object = "post", .times = {0.0, 2.0}, .world_from_object = {{}, {.orientation = turned}}}};
  const Scene scene = scara_beside(
      "max_speed: 1, parts: [{name: a, sphere: {radius: 0.1}, pose: {xyz: [2.4, 0, 0]}}]");
  const Answer answer = answered(scene, question);
  EXPECT_LE(answer.lower, 0.25 + 1e-12);
  EXPECT_GE(answer.lower, 0.25 - 1e-3);
  EXPECT_GE(answer.upper, 0.25 - 1e-12);
}

TEST(MotionsOfOthers, AMotionBesideIsThatOfOneWithAllWaypoints) {
  const Scene scene = scara_beside(kPin);
  Question one;
  one.held = {{"push", 0.0}};
  one.tolerance = 1e-7;
  one.motion = {.joints = {"shoulder", "elbow"},
                .times = {0.0, 0.5, 1.25, 2.0},
                .positions = {-1.0, 0.4, -0.6, 0.4, 0.0, -0.2, 0.6, -0.2},
                .velocities = {}};
  Question two = one;
  two.motion = {
      .joints = {"shoulder"}, .times = {0.0, 2.0}, .positions = {-1.0, 0.6}, .velocities = {}};
  two.beside = {
      {.joints = {"elbow"}, .times = {0.5, 1.25}, .positions = {0.4, -0.2}, .velocities = {}}};
  const Answer a = answered(scene, one), b = answered(scene, two);
  EXPECT_LE(a.lower, b.upper);
  EXPECT_LE(b.lower, a.upper);
  EXPECT_NEAR(a.upper, b.upper, 1e-7);
}

TEST(MotionsOfOthers, AMotionOfAnObjectTakesNoStepThatIsTooShort) {
  Question question = swing(0.0, 0.0);
  const auto ask_with = [&](double step) {
    question.moving = {
        {.object = "post",
         .times = {0.0, step},
         .world_from_object = {{.position = {2.4, -1.0, 0.0}}, {.position = {2.4, 1.0, 0.0}}}}};
    return ask(scara_beside(kBall), question);
  };
  EXPECT_TRUE(std::holds_alternative<std::string>(ask_with(1e-110)));
  const auto passed = ask_with(1e-19);
  ASSERT_TRUE(std::holds_alternative<Answer>(passed));
  EXPECT_LE(std::get<Answer>(passed).lower, 0.25 + 1e-9);
}

TEST(MotionsOfOthers, APoseAndAMotionOfOneObjectAreRefused) {
  Question question = swing(0.0, 0.0);
  question.poses = {{.object = "post", .world_from_object = {}}};
  question.moving = {{.object = "post", .times = {0.0}, .world_from_object = {{}}}};
  EXPECT_TRUE(std::holds_alternative<std::string>(ask(scara_beside(kBall), question)));
}

}  // namespace
}  // namespace clearance
