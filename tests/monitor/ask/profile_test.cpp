// Oracles: the closed form of a distance over time, and the equations of S_p.
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "tests/monitor/ask/scara_questions.hpp"

namespace clearance {
namespace {

using test::answered, test::kPin, test::scara_beside, test::swing;

double to_pin(double angle) {
  return std::hypot(2.3 - 2.0 * std::cos(angle), 2.0 * std::sin(angle)) - 0.15;
}

TEST(Profile, CoversTheMotionAndHoldsAtAllInstants) {
  Question question = swing(-1.0, 0.6);
  question.profile = {.first = "post", .second = "finger", .tolerance = 0.01};
  const Answer answer = answered(scara_beside(kPin), question);
  ASSERT_FALSE(answer.profile.empty());
  double end = 0.0;
  for (const ProfilePoint& point : answer.profile) {
    EXPECT_EQ(point.from, end);
    end = point.to;
    EXPECT_LE(point.upper - point.lower, 0.01);
    for (int i = 0; i <= 8; ++i) {
      const double t = point.from + 0.125 * i * (point.to - point.from);
      EXPECT_LE(point.lower, to_pin(0.8 * t - 1.0) + 1e-12);
      EXPECT_GE(point.upper, to_pin(0.8 * t - 1.0) - 1e-12);
    }
  }
  EXPECT_EQ(end, 2.0);
}

TEST(Profile, OfAllPairsIsNeverAboveThatOfOne) {
  const Scene scene = scara_beside(kPin);
  Question question = swing(-1.0, 0.6);
  question.profile = {.first = "", .second = "", .most_points = 40};
  const Answer least = answered(scene, question);
  EXPECT_EQ(least.profile.size(), 40u);
  for (const ProfilePoint& point : least.profile) {
    EXPECT_LE(point.lower, point.upper);
    EXPECT_LE(point.lower, to_pin(0.4 * (point.from + point.to) - 1.0) + 1e-12);
  }
  question.profile = {.first = "post", .second = "nothing"};
  EXPECT_TRUE(std::holds_alternative<std::string>(ask(scene, question)));
}

// An answer of 'free' would be about nothing.
TEST(MarginsBetween, PairsThatTheQuestionDoesNotMoveAreRefused) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  const Scene scene = scene_of(
      "name: test\nunits: {length: m, angle: rad}\nrobots:\n  - {name: arm, urdf: scara.urdf}\n"
      "  - {name: other, prefix: o_, urdf: scara.urdf, base: {pose: {xyz: [9, 0, 0]}}}\nobjects:\n"
      "  - {name: post, max_speed: 2, sphere: {radius: 0.1}}\n"
      "  - {name: wall, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [0, 9, 0]}}\n"
      "pairs: [{between: [arm, post]}, {between: [post, wall]}, {between: [other, wall]}]\n",
      folder / "cell.yaml");
  Question question = swing(-1.0, 0.6);
  question.others = OthersMove::kNot;
  question.poses = {{.object = "post", .world_from_object = {.position = {3.0, 0.0, 0.0}}}};
  for (const char* joint : {"o_shoulder", "o_elbow", "o_push"})
    question.joints.push_back({.name = joint});
  const auto is_refused = [&](const std::string& a, const std::string& b) {
    question.margins_between = {{a, b, 0.1}};
    return std::holds_alternative<std::string>(ask(scene, question));
  };
  EXPECT_FALSE(is_refused("arm", "post"));
  EXPECT_TRUE(is_refused("post", "wall"));
  EXPECT_TRUE(is_refused("other", "wall"));
  question.margins_between.clear();
  question.profile = {.first = "o_finger", .second = "wall"};
  EXPECT_TRUE(std::holds_alternative<std::string>(ask(scene, question)));
}

// The person walks at 0.1 m/s; the robot reacts in 0.5 s and stops in 0.5 s and 0.1 m.
constexpr const char* kZone =
    "zones:\n  - {name: people, between: [post, finger], enter_below: 0.01, leave_above: 0.02, "
    "separation: {human: post, human_speed: 0.1, reaction_time_ms: 500, stopping_time_ms: 500, "
    "stopping_distance: 0.1, intrusion_distance: 0}}\n";

// The distance is least at the angle 0. The fastest point of the finger moves at 0.8 x 2.05 m/s.
TEST(TimeScaling, IsTheLargestFactorThatKeepsTheProtectiveDistance) {
  const Scene scene = scara_beside("max_speed: 2, sphere: {radius: 0.1}", kZone);
  Question question = swing(-1.0, 0.6);
  question.others = OthersMove::kNot;
  question.poses = {{.object = "post", .world_from_object = {.position = {3.0, 0.0, 0.0}}}};
  question.time_scaling = true;
  question.scaling_tolerance = 1e-4;
  const Answer answer = answered(scene, question);
  const double admitted = 0.85 - 0.1 * (0.5 + 0.5) - 0.1;  // m, for the path while it reacts
  const double truth = admitted / 0.5 / (0.8 * 2.05);
  EXPECT_TRUE(answer.scaling.is_limited);
  EXPECT_LE(answer.scaling.factor, truth + 1e-9);
  EXPECT_GE(answer.scaling.factor, truth * (1.0 - 1e-3));
  EXPECT_GE(answer.scaling.factor_above, truth - 1e-9);
  EXPECT_NEAR(answer.scaling.time, 1.25, 0.1);
  // The person has been walking for the age of the pose, as S_p of a tick has it.
  question.poses[0].age = 2.0;
  const Answer later = answered(scene, question);
  const double slower = (admitted - 0.1 * 2.0) / 0.5 / (0.8 * 2.05);
  EXPECT_LE(later.scaling.factor, slower + 1e-9);
  EXPECT_GE(later.scaling.factor, slower * (1.0 - 1e-3));
  question.poses[0].age = 0.0;
  // The person is too near for a robot that stands.
  question.poses[0].world_from_object.position = {2.3, 0.0, 0.0};
  EXPECT_EQ(answered(scene, question).scaling.factor, 0.0);
}

// What reports take is measured while the daemon runs: no question knows it.
TEST(TimeScaling, IsRefusedIfAZoneMeasuresItsReaction) {
  Scene scene = scara_beside("max_speed: 2, sphere: {radius: 0.1}", kZone);
  scene.zones.at(0).separation->reaction_is_measured = true;
  Question question = swing(-1.0, 0.6);
  question.others = OthersMove::kNot;
  question.poses = {{.object = "post", .world_from_object = {.position = {3.0, 0.0, 0.0}}}};
  EXPECT_TRUE(std::holds_alternative<Answer>(ask(scene, question)));
  question.time_scaling = true;
  EXPECT_TRUE(std::holds_alternative<std::string>(ask(scene, question)));
}

// A person whose limbs move, and an arm: a zone limits the arm, wherever it stands in the cell.
TEST(TimeScaling, DoesNotDependOnTheOrderOfRobots) {
  const std::string arm = "  - {name: arm, urdf: scara.urdf}\n",
                    person =
                        "  - {name: p, person: {stature: 1.75, error: 0.1}, groups: [people], "
                        "base: {pose: {xyz: [3.2, 0, 0]}}}\n";
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  std::vector<TimeScaling> found;
  for (const std::string& robots : {arm + person, person + arm}) {
    const Scene scene = scene_of(
        "name: test\nunits: {length: m, angle: rad}\nrobots:\n" + robots +
            "pairs: [{between: [arm, people]}]\nzones:\n  - {name: z, between: [arm, people], "
            "enter_below: 0.01, leave_above: 0.02, separation: {human: people, human_speed: 0.1, "
            "reaction_time_ms: 100, stopping_time_ms: 100, stopping_distance: 0.05, "
            "intrusion_distance: 0}}\n",
        folder / "cell.yaml");
    Question question = swing(-1.0, 0.6);
    question.others = OthersMove::kNot;
    question.time_scaling = true;
    question.held.clear();
    for (const JointVariable& variable : scene.variables)
      if (variable.name != "shoulder") question.held.push_back({variable.name, 0.0});
    found.push_back(answered(scene, question).scaling);
    // Positions of the person's joints that are old count as an old pose does.
    std::erase_if(question.held, [&](const HeldJoint& held) {
      const bool is_of_arm = held.name == "elbow" || held.name == "push";
      if (!is_of_arm) question.joints.push_back({.name = held.name, .age = 1.0});
      return !is_of_arm;
    });
    EXPECT_LT(answered(scene, question).scaling.factor_above, found.back().factor);
    EXPECT_TRUE(found.back().is_limited);
    EXPECT_LT(found.back().factor_above, kInfinity);
  }
  const double tolerance = Question().scaling_tolerance;
  EXPECT_NEAR(found[0].factor, found[1].factor, 2.0 * tolerance * found[0].factor);
  EXPECT_LE(found[0].factor, found[1].factor_above);
  EXPECT_LE(found[1].factor, found[0].factor_above);
}

// Neither of two links is the tip of a chain and its base at once.
TEST(TimeScaling, IsRefusedIfEachOfTwoLinksIsTheHumanOfTheOther) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  const auto zone = [](const std::string& name, const std::string& human) {
    return "  - {name: " + name +
           ", between: [a, b], enter_below: 0.01, leave_above: 0.02, "
           "separation: {human: " +
           human +
           ", human_speed: 0.1, reaction_time_ms: 100, stopping_time_ms: 100, stopping_distance: "
           "0.05, intrusion_distance: 0}}\n";
  };
  const auto ask_with = [&](const std::string& zones) {
    const Scene scene = scene_of(
        "name: test\nunits: {length: m, angle: rad}\nrobots:\n"
        "  - {name: a, prefix: a_, urdf: scara.urdf}\n"
        "  - {name: b, prefix: b_, urdf: scara.urdf, base: {pose: {xyz: [6, 0, 0]}}}\n"
        "pairs: [{between: [a, b]}]\nzones:\n" +
            zones,
        folder / "cell.yaml");
    Question question = swing(-1.0, 0.6);
    question.motion.joints = {"a_shoulder"};
    question.held = {
        {"a_elbow", 0.0}, {"a_push", 0.0}, {"b_shoulder", 0.0}, {"b_elbow", 0.0}, {"b_push", 0.0}};
    question.others = OthersMove::kNot;
    question.time_scaling = true;
    return ask(scene, question);
  };
  EXPECT_TRUE(std::holds_alternative<Answer>(ask_with(zone("one", "a"))));
  EXPECT_TRUE(std::holds_alternative<Answer>(ask_with(zone("one", "b"))));
  EXPECT_TRUE(std::holds_alternative<std::string>(ask_with(zone("one", "a") + zone("two", "b"))));
}

TEST(TimeScaling, HasNoLimitWithoutSuchAZone) {
  Question question = swing(-1.0, 0.6);
  question.time_scaling = true;
  const Answer answer = answered(scara_beside(kPin), question);
  EXPECT_FALSE(answer.scaling.is_limited);
  EXPECT_EQ(answer.scaling.factor, kInfinity);
}

}  // namespace
}  // namespace clearance
