// Oracle: closed forms of the distances of spheres.
#include "core/shapes.hpp"
#include "tests/monitor/ask/scara_questions.hpp"

namespace clearance {
namespace {

using test::answered, test::kPin, test::scara_beside, test::swing;

// A ball of 0.02 m, 0.15 m in front of the finger's centre.
Payload ball() {
  return {.name = "ball",
          .shape = std::get<ConvexBody>(point(Vec3::Zero(), 0.02)),
          .link = "finger",
          .link_from_object = {.position = {0.15, 0.0, 0.0}},
          .touch = {}};
}

TEST(Payloads, ANewObjectIsCarriedThroughTheMotion) {
  const Scene scene = scara_beside(kPin);
  Question question = swing(-1.0, 0.6);
  question.tolerance = 1e-6;
  question.payloads = {ball()};
  const Answer answer = answered(scene, question);
  EXPECT_NEAR(answer.lower, 0.03, 1e-6);
  EXPECT_LE(answer.lower, 0.03 + 1e-12);
  EXPECT_EQ(object_name(scene, question, answer.first) + " " +
                object_name(scene, question, answer.second),
            "post ball");
}

TEST(Payloads, AnObjectOfTheCellNeedsNoPoseWhenItIsCarried) {
  const Scene scene = scara_beside("max_speed: 1, sphere: {radius: 0.02}");
  Question question = swing(-1.0, 0.6);
  question.payloads = {{.name = "post",
                        .shape = {},
                        .link = "finger",
                        .link_from_object = {.position = {0.15, 0.0, 0.0}},
                        .touch = {}}};
  // The load is 0.13 m in front of the forearm's end, which is 0.1 m behind the finger's centre.
  EXPECT_NEAR(answered(scene, question).lower, 0.23, 1e-3);
  question.payloads[0].touch = {"lower"};
  EXPECT_GT(answered(scene, question).lower, 0.3);
}

// As if a collision matrix of MoveIt allowed every pair of the cell.
TEST(Payloads, LeaveAPersonWatchedWhateverMayTouch) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  Scene scene = scene_of(
      "name: test\nunits: {length: m, angle: rad}\nrobots:\n  - {name: arm, urdf: scara.urdf}\n"
      "  - {name: anna, person: {stature: 1.7, error: 0.06}, base: {pose: {xyz: [1.2, 0.5, 0]}}}\n"
      "pairs: [{between: [arm, anna]}]\n",
      folder / "cell.yaml");
  Question question = swing(-1.0, 0.6);
  question.others = OthersMove::kNot;
  for (const JointVariable& variable : scene.variables) {
    const bool is_of_anna = scene.robots[variable.robot].person.has_value();
    if (is_of_anna) question.held.push_back({variable.name, 0.0});
  }
  const Answer without = answered(scene, question);
  EXPECT_LT(without.lower, 0.5);
  scene.may_touch = scene.pairs;
  question.payloads = {ball()};
  EXPECT_LE(answered(scene, question).lower, without.upper);
}

TEST(Payloads, FaultsAreSentences) {
  const Scene scene = scara_beside(kPin);
  Question question = swing(-1.0, 0.6);
  question.payloads = {ball()};
  question.payloads[0].link = "hand";
  EXPECT_TRUE(std::holds_alternative<std::string>(ask(scene, question)));
  question.payloads[0] = ball();
  question.payloads[0].touch = {"nothing"};
  EXPECT_TRUE(std::holds_alternative<std::string>(ask(scene, question)));
  question.payloads[0] = ball();
  question.payloads[0].shape.reset();
  EXPECT_TRUE(std::holds_alternative<std::string>(ask(scene, question)));
}

}  // namespace
}  // namespace clearance
