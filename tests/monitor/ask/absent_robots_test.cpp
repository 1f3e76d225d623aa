// Robots that are absent, and quaternions that are none. Oracle: the same cell without the robot,
// and the closed form of two spheres.
#include <gmock/gmock.h>

#include "tests/monitor/ask/scara_questions.hpp"

namespace clearance {
namespace {

using test::answered, test::swing;
using testing::HasSubstr;

// The arm beside a post, and a second one, with its tool and a ball in its hand.
Scene with_second_arm(const std::string& keys) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  return scene_of(
      "name: test\nunits: {length: m, angle: rad}\nrobots:\n"
      "  - {name: arm, urdf: scara.urdf}\n"
      "  - {name: second, urdf: scara.urdf, prefix: b_, base: {pose: {xyz: [0.3, 0, 0]}}" +
          keys +
          "}\nobjects:\n"
          "  - {name: post, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [2.3, 0, 0]}}\n"
          "  - {name: ball, attached: {to: b_finger, touch: [second]}, sphere: {radius: 0.02}}\n"
          "pairs: [{between: [arm, post]}, {between: [arm, second]}, {between: [second, post]}, "
          "{between: [arm, ball]}]\n",
      folder / "cell.yaml");
}

Question precise_swing() {
  Question question = swing(-1.0, 0.6);
  question.tolerance = 1e-9;
  return question;
}

std::string refusal(const Scene& scene, const Question& question) {
  const std::variant<Answer, std::string> answer = ask(scene, question);
  return std::holds_alternative<std::string>(answer) ? std::get<std::string>(answer) : "";
}

TEST(AbsentRobots, NeedNoPositionsAndTheirLinksAreLeftOut) {
  const Scene scene = with_second_arm(", absent: true");
  const Answer answer = answered(scene, precise_swing());
  EXPECT_NEAR(answer.lower, 0.15, 1e-9) << "the distance of the finger and the post";
  EXPECT_NEAR(answer.upper, 0.15, 1e-9);
  EXPECT_EQ(scene.objects[answer.first].name + scene.objects[answer.second].name, "postfinger");
}

TEST(AbsentRobots, CountWhereTheQuestionStatesAPosition) {
  const Scene scene = with_second_arm(", absent: true");
  Question question = precise_swing();
  question.held.push_back({"b_elbow", 0.0});
  EXPECT_THAT(refusal(scene, question), HasSubstr("has no position"));
  question.held.push_back({"b_shoulder", 0.0});
  question.held.push_back({"b_push", 0.0});
  EXPECT_EQ(answered(scene, question).upper, 0.0) << "it stands in the first arm";
}

TEST(AbsentRobots, ThatArePresentNeedPositions) {
  EXPECT_THAT(refusal(with_second_arm(""), precise_swing()), HasSubstr("has no position"));
}

// The order of questions has no meaning.
TEST(AbsentRobots, OfOneQuestionAreNoOtherQuestionsRobots) {
  const Scene scene = with_second_arm(", absent: true");
  Question held = precise_swing();
  for (const char* joint : {"b_shoulder", "b_elbow", "b_push"}) held.held.push_back({joint, 0.0});
  Asker asker(scene);
  for (int i = 0; i < 2; ++i) {
    Answer answer;
    ASSERT_EQ(asker.ask(precise_swing(), answer), std::nullopt);
    EXPECT_NEAR(answer.upper, 0.15, 1e-9);
    ASSERT_EQ(asker.ask(held, answer), std::nullopt);
    EXPECT_EQ(answer.upper, 0.0);
  }
}

TEST(AbsentRobots, AbsentFixedObjectsAreLeftOut) {
  const Scene scene = test::scara_beside(
      "fixed: true, absent: true, sphere: {radius: 0.1}, pose: {xyz: [2.0, 0, 0]}");
  EXPECT_GT(answered(scene, precise_swing()).lower, 0.0);
}

// A person stands far away. The tolerance is that of the tick.
TEST(Quaternions, OfFloatingJointsHaveTheLengthOneOrAreRefused) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  const Scene scene = scene_of(
      "name: test\nunits: {length: m, angle: rad}\nros2: {world_frame: map}\nrobots:\n"
      "  - {name: anna, person: {stature: 1.75, error: 0}}\n"
      "  - {name: arm, urdf: scara.urdf}\n"
      "pairs: [{between: [arm, anna]}]\n",
      folder / "cell.yaml");
  const auto question = [&](double x, double y, double z, double w) {
    Question of = precise_swing();
    for (const JointVariable& variable : scene.variables) {
      if (variable.robot != 0) continue;
      const std::string& name = variable.name;
      const auto ends_with = [&](const char* end) { return name.ends_with(end); };
      of.held.push_back({name, ends_with("rot_x")     ? x
                               : ends_with("rot_y")   ? y
                               : ends_with("rot_z")   ? z
                               : ends_with("rot_w")   ? w
                               : ends_with("trans_x") ? 20.0
                                                      : 0.0});
    }
    return of;
  };
  EXPECT_EQ(refusal(scene, question(0, 0, 0, 1)), "");
  EXPECT_EQ(refusal(scene, question(0.6, 0, 0, -0.8)), "");
  EXPECT_EQ(refusal(scene, question(0, 0, 1.0009, 0)), "") << "as sent in single precision";
  EXPECT_THAT(refusal(scene, question(0, 0, 0, 2)), HasSubstr("\"anna_base\" has the length 2;"));
  for (const double length : {0.0, 1e-200, 0.5, 0.9985, 1.0015, 1e5})
    EXPECT_THAT(refusal(scene, question(0, length, 0, 0)), HasSubstr("quaternion")) << length;
}

}  // namespace
}  // namespace clearance
