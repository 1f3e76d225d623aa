// A question is completed by what the daemon knows, and by nothing that it does not know.
#include "monitor/ask/completion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "monitor/tick/read_inputs.hpp"
#include "tests/monitor/tick/scara_cell.hpp"

namespace clearance {
namespace {

using PoseState = PresentPose::State;

// Joints shoulder, elbow, push; the cart is the only object with poses of its own.
struct Known {
  Known() {
    for (std::size_t i = 0; i < 3; ++i)
      state.joints[i] = {PoseState::kUsable, 0.1 * static_cast<double>(i + 1), 0.0};
    state.objects.at(0).pose = {PoseState::kUsable, {.position = {1, 2, 3}}};
    state.objects.at(0).age = 0.25;
    question.motion = {
        .joints = {"shoulder"}, .times = {0.0, 1.0}, .positions = {0.0, 1.0}, .velocities = {}};
  }
  std::optional<std::string> completed() { return complete(scene, state, {}, question); }

  Scene scene = test::scara_cell();
  InputState state = room_for_inputs(scene);
  Question question;
};

TEST(QuestionCompletion, TakesJointsAndPosesThatTheQuestionLacks) {
  Known known;
  ASSERT_EQ(known.state.objects.size(), 1u);
  EXPECT_EQ(known.completed(), std::nullopt);
  ASSERT_EQ(known.question.held.size(), 2u);
  EXPECT_EQ(known.question.held[0].name, "elbow");
  EXPECT_EQ(known.question.held[0].position, 0.2);
  EXPECT_EQ(known.question.held[1].position, 0.1 * 3);
  ASSERT_EQ(known.question.poses.size(), 1u);
  EXPECT_EQ(known.question.poses[0].object, "cart");
  EXPECT_EQ(known.question.poses[0].world_from_object.position, Vec3(1, 2, 3));
  EXPECT_EQ(known.question.poses[0].age, 0.25);
}

TEST(QuestionCompletion, KeepsWhatTheQuestionStates) {
  Known known;
  known.question.held = {{"elbow", 9.0}};
  known.question.poses = {{.object = "cart", .world_from_object = {.position = {7, 7, 7}}}};
  known.question.beside = {
      {.joints = {"push"}, .times = {0.0}, .positions = {0.0}, .velocities = {}}};
  known.state = room_for_inputs(known.scene);
  EXPECT_EQ(known.completed(), std::nullopt) << "nothing else is needed";
  EXPECT_EQ(known.question.held.size(), 1u);
  EXPECT_EQ(known.question.held[0].position, 9.0);
  EXPECT_EQ(known.question.poses.size(), 1u);
}

TEST(QuestionCompletion, NamesWhatIsNotUsable) {
  for (const PoseState state : {PoseState::kUnknown, PoseState::kLate, PoseState::kContradicted}) {
    Known known;
    known.state.joints[1].state = state;
    EXPECT_NE(known.completed().value_or("").find("'elbow'"), std::string::npos);
  }
  for (const PoseState state : {PoseState::kUnknown, PoseState::kLate, PoseState::kContradicted}) {
    Known known;
    known.state.objects[0].pose.state = state;
    EXPECT_NE(known.completed().value_or("").find("'cart'"), std::string::npos);
  }
}

// The joint that moves needs no present position.
TEST(QuestionCompletion, NeedsNoPositionOfAJointWithWaypoints) {
  Known known;
  known.state.joints[0].state = PoseState::kLate;
  EXPECT_EQ(known.completed(), std::nullopt);
  EXPECT_TRUE(
      std::isinf(start_deviation(known.scene, known.state, known.question.motion).deviation));
}

TEST(QuestionCompletion, LeavesOutWhatIsAbsent) {
  Known known;
  known.state.objects[0].pose.state = PoseState::kAbsent;
  EXPECT_EQ(known.completed(), std::nullopt);
  EXPECT_TRUE(known.question.poses.empty());
}

TEST(QuestionCompletion, RefusesAJointThatMovesUnlessTheQuestionSaysThatNothingElseMoves) {
  for (const double velocity : {0.1, -0.1, std::numeric_limits<double>::quiet_NaN()}) {
    Known known;
    known.state.joints[1].velocity = velocity;
    EXPECT_NE(known.completed().value_or("").find("'elbow'"), std::string::npos) << velocity;
    known.question.others = OthersMove::kNot;
    EXPECT_EQ(known.completed(), std::nullopt) << velocity;
  }
}

TEST(QuestionCompletion, MeasuresTheStartOfAnAngleThatWrapsByTheShorterArc) {
  Known known;
  known.question.motion.joints = {"elbow"};
  known.question.motion.positions = {0.2 + 2.0 * std::acos(-1.0), 0.0};
  const StartDeviation start = start_deviation(known.scene, known.state, known.question.motion);
  EXPECT_EQ(start.joint, "elbow");
  EXPECT_NEAR(start.deviation, 0.0, 1e-12);
}

// The ends are on three clocks; the question has that of its waypoints.
TEST(QuestionCompletion, TakesTheContactsThatTheTickAllowsWithTheirEnds) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  const Scene scene = scene_of(
      "name: test\nunits: {length: m, angle: rad}\nrate_hz: 500\n"
      "robots: [{name: arm, urdf: scara.urdf}]\n" +
          test::kScaraRest +
          "contacts:\n"
          "  - {name: a, between: [finger, wall], by: test, reason: meant, depth: 0.01,\n"
          "     until: {duration_ms: 2000, distance: 0.03}}\n"
          "  - {name: b, between: [upper, wall], by: test, reason: meant, depth: 0.02,\n"
          "     until: {cycle: 150}}\n"
          "  - {name: c, between: [lower, wall], by: test, reason: meant, depth: 0.03}\n"
          "  - {name: d, between: [cart, wall], by: test, reason: meant, depth: 0.04}\n",
      folder / "cell.yaml");
  InputState state = room_for_inputs(scene);
  state.cycle = 100;
  state.now_ns = 10'000'000'000;
  ASSERT_EQ(state.contacts.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const ContactPair of = contact_pairs(scene)[i];
    state.contacts[i] = {
        .contact = of.contact, .pair = of.pair, .since_cycle = 50, .since_ns = 9'500'000'000};
    if (of.contact == 2) state.contacts[i].ended = ContactEnded::kByDistance;
    if (of.contact == 3) state.contacts[i].since_cycle = 0;  // no tick has had it yet
  }
  Question question;
  question.motion = {.joints = {"shoulder", "elbow", "push"},
                     .times = {3.0},
                     .positions = {0.0, 0.0, 0.0},
                     .velocities = {}};
  question.poses = {{.object = "cart", .world_from_object = {}}};
  EXPECT_EQ(complete(scene, state, {}, question), std::nullopt);
  ASSERT_EQ(question.contacts.value().size(), 2u);
  for (const MeantContact& contact : *question.contacts) {
    EXPECT_EQ(contact.first, "wall");
    const bool is_first = contact.second == "finger";
    EXPECT_EQ(contact.depth, is_first ? 0.01 : 0.02);
    EXPECT_NEAR(contact.until, is_first ? 4.5 : 3.1, 1e-12);
    EXPECT_EQ(contact.distance, is_first ? 0.03 : kInfinity);
  }
}

// A robot that the question does not name may move: its joints are stated with their ages.
TEST(QuestionCompletion, TakesTheJointsOfOtherRobotsAsThoseThatOthersMove) {
  const Cell cell = test::two_scara_arms();
  InputState state = room_for_inputs(cell.scene);
  for (std::size_t i = 0; i < state.joints.size(); ++i) {
    state.joints[i] = {PoseState::kUsable, 0.1 * static_cast<double>(i), 5.0};
    state.joint_ages[i] = 0.01 * static_cast<double>(i);
  }
  Question question;
  question.motion = {.joints = {"left_shoulder", "left_elbow", "left_push"},
                     .times = {0.0},
                     .positions = {0.0, 0.0, 0.0},
                     .velocities = {}};
  EXPECT_EQ(complete(cell.scene, state, {}, question), std::nullopt) << "though they move";
  EXPECT_TRUE(question.held.empty());
  ASSERT_EQ(question.joints.size(), 3u);
  EXPECT_EQ(question.joints[0].name, "right_shoulder");
  EXPECT_EQ(question.joints[2].position, 0.1 * 5);
  EXPECT_EQ(question.joints[2].age, 0.01 * 5);
  EXPECT_EQ(question.joints[2].speed, 5.0);
}

}  // namespace
}  // namespace clearance
