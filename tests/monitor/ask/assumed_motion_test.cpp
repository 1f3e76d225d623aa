// Oracles: closed forms, and postures that the assumption admits, drawn at random.
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "tests/monitor/ask/scara_questions.hpp"

namespace clearance::assumed_motion_test {
namespace {

using test::answered;

Scene two_arms() {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  return scene_of(
      "name: test\nunits: {length: m, angle: rad}\nrobots:\n"
      "  - {name: left, urdf: scara.urdf, prefix: left_}\n"
      "  - {name: right, urdf: scara.urdf, prefix: right_, base: {pose: {xyz: [4.6, 0, 0]}}, "
      "joints: "
      "{elbow: {velocity: 1.5}}}\n"
      "objects: [{name: post, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [4.6, 2.2, 0]}}]\n"
      "pairs: [{between: [left, right]}, {between: [right, post]}]\n",
      folder / "cell.yaml");
}

Scene arm_on_a_cart(const std::string& speed, const std::string& pairs = "") {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  return scene_of(
      "name: test\nunits: {length: m, angle: rad}\nrobots:\n"
      "  - {name: arm, urdf: scara.urdf, base: {on: cart, pose: {xyz: [0.3, 0, 0]}}}\n"
      "objects:\n"
      "  - {name: post, fixed: true, box: {size: [0.3, 0.2, 0.4]}, pose: {xyz: [2.9, 0.4, 0]}}\n"
      "  - {name: cart, box: {size: [0.5, 0.5, 0.2]}" +
          speed + "}\npairs: [{between: [arm, post]}, {between: [cart, post]}" + pairs + "]\n",
      folder / "cell.yaml");
}

// The left arm swings; the right one is stretched towards the left.
Question beside_the_right_arm(const std::vector<StatedJoint>& right) {
  Question question;
  question.motion = {
      .joints = {"left_shoulder"}, .times = {1.0, 2.0}, .positions = {0.4, 0.9}, .velocities = {}};
  question.held = {{"left_elbow", 0.0}, {"left_push", 0.0}};
  question.joints = right;
  return question;
}

const std::vector<StatedJoint> kRight = {
    {"right_shoulder", 2.6, 0.1}, {"right_elbow", 0.3, 0.1}, {"right_push", 0.05, 0.1}};

TEST(AssumedMotion, ASlidingJointComesNearerByItsSpeedAndNoFartherThanItsLimit) {
  const Scene scene = two_arms();
  // Finger to finger along x: 4.6 - 2.0 - 2.05 - 0.1 less what the right finger slides.
  Question question;
  question.motion = {
      .joints = {"left_shoulder"}, .times = {1.0, 1.2}, .positions = {0.0, 0.0}, .velocities = {}};
  question.held = {
      {"left_elbow", 0.0}, {"left_push", 0.0}, {"right_shoulder", M_PI}, {"right_elbow", 0.0}};
  question.held[2].position = 3.0;
  question.joints = {{"right_push", 0.05, 0.0}};
  question.tolerance = 1e-9;
  const double x = 4.6 + 2.05 * std::cos(3.0) - 2.0, y = 2.05 * std::sin(3.0);
  const double now = std::hypot(x, y) - 0.1;
  Answer answer = answered(scene, question);
  EXPECT_NEAR(answer.lower, now - 0.5 * 0.2, 1e-6);
  EXPECT_NEAR(answer.upper, now - 0.5 * 0.2, 1e-6);
  question.joints[0].speed = 0.6;
  EXPECT_NEAR(answered(scene, question).lower, now - 0.6 * 0.2, 1e-6) << "beyond its limit";
  question.joints[0].age = 9.0;
  answer = answered(scene, question);
  const auto push = std::ranges::find(scene.variables, "right_push", &JointVariable::name);
  EXPECT_NEAR(answer.lower, now - 0.15 - push->limit_tolerance, 1e-6);
  question.others = OthersMove::kNot;
  EXPECT_NEAR(answered(scene, question).lower, now, 1e-8);
}

TEST(AssumedMotion, NoPostureThatItAdmitsIsNearerThanTheLowerBound) {
  const Scene scene = two_arms();
  std::mt19937_64 engine(35);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  };
  Asker asker(scene);
  double closest = 1e300;
  for (int round = 0; round < 20; ++round) {
    std::vector<StatedJoint> right = kRight;
    right[0].position = between(-2.5, 2.5);
    right[1].position = between(-2.5, 2.5);
    const Question question = beside_the_right_arm(right);
    const Answer answer = answered(scene, question);
    ASSERT_TRUE(answer.has_pair);
    EXPECT_LE(answer.upper - answer.lower, 1e-3);
    for (int i = 0; i < 50; ++i) {
      const double t = between(1.0, 2.0), since = t - 1.0 + 0.1;
      Question posture = beside_the_right_arm({});
      posture.tolerance = 1e-12;
      posture.motion.times = {0.0};
      posture.motion.positions = {0.4 + 0.5 * (t - 1.0)};
      const double speeds[] = {2.0, 1.5, 0.5};
      for (std::size_t j = 0; j < 3; ++j) {
        const double most = speeds[j] * since;
        double position = right[j].position + (i % 2 == 0 ? between(-most, most) : most);
        const double limits[] = {3.0, 3.0, 0.2};
        position = std::clamp(position, j == 2 ? 0.0 : -limits[j], limits[j]);
        posture.held.push_back({right[j].name, position});
      }
      posture.profile = ProfileRequest{.first = "left_finger", .second = "right_finger"};
      Answer fingers;
      ASSERT_FALSE(asker.ask(posture, fingers));
      EXPECT_LE(answer.lower, fingers.profile[0].upper + 1e-12) << round;
      closest = std::min(closest, fingers.profile[0].upper - answer.lower);
    }
  }
  EXPECT_LT(closest, 1.5);
}

// The right arm may touch the post by itself: that is no matter of the left arm's motion.
TEST(AssumedMotion, PairsOfOtherRobotsAloneDoNotCount) {
  const Scene scene = two_arms();
  Question question = beside_the_right_arm(
      {{"right_shoulder", 1.57, 0.1}, {"right_elbow", 0.0, 0.1}, {"right_push", 0.0, 0.1}});
  question.motion.positions = {2.8, 2.8};
  question.motion.times = {1.0, 1.05};
  EXPECT_GT(answered(scene, question).lower, 0.5);
  question.others = OthersMove::kNot;
  EXPECT_GT(answered(scene, question).lower, 0.5) << "whatever is assumed of its motion";
  question.joints.clear();
  for (const auto& [name, position] : {std::pair("right_shoulder", 1.57), {"right_elbow", 0.0}})
    question.held.push_back({name, position});
  question.held.push_back({"right_push", 0.0});
  EXPECT_LT(answered(scene, question).upper, 0.2) << "the question states that it stays there";
}

// To assume that others rest is stronger than to assume that they move by max_speed.
TEST(AssumedMotion, AnAnswerIsNeverWorseForTheStrongerAssumption) {
  const Scene scene = two_arms(),
              carried = arm_on_a_cart(", max_speed: 0.05", ", {between: [arm, cart]}");
  std::mt19937_64 engine(57);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  };
  const auto expect_law = [](const Scene& of, Question question, int round) {
    question.tolerance = 1e-6;
    const Answer moving = answered(of, question);
    question.others = OthersMove::kNot;
    const Answer resting = answered(of, question);
    EXPECT_EQ(resting.has_pair, moving.has_pair) << round;
    EXPECT_GE(resting.upper, moving.lower) << round;
    EXPECT_GE(resting.lower, moving.lower - question.tolerance) << round;
    if (moving.margins[0].verdict == Verdict::kFree) {
      EXPECT_EQ(resting.margins[0].verdict, Verdict::kFree) << round;
    }
  };
  for (int round = 0; round < 100; ++round) {
    expect_law(scene,
               beside_the_right_arm({{"right_shoulder", between(-3.0, 3.0), between(0.0, 0.2)},
                                     {"right_elbow", between(-2.5, 2.5), 0.1},
                                     {"right_push", between(0.0, 0.15), 0.1}}),
               round);
    Question cart = test::swing(between(-1.0, 1.0), between(-1.0, 1.0));
    cart.poses = {
        {.object = "cart",
         .world_from_object = {.position = {between(-0.5, 0.5), between(0.0, 1.0), 0.0}}}};
    cart.poses[0].age = between(0.0, 1.0);
    expect_law(carried, cart, round);
    // A joint of the arm rests by assumption, too.
    cart.held = {{"elbow", between(-2.0, 2.0)}};
    cart.joints = {{"push", 0.1, 0.0}};
    expect_law(carried, cart, round);
  }
}

TEST(AssumedMotion, AJointWithoutAnyLimitIsRefusedByItsName) {
  const Scene scene = two_arms();  // the left elbow is continuous, and has no velocity
  Question question;
  question.motion = {
      .joints = {"right_shoulder"}, .times = {0.0, 1.0}, .positions = {0.0, 0.0}, .velocities = {}};
  question.held = {
      {"right_push", 0.0}, {"right_elbow", 0.0}, {"left_shoulder", 0.0}, {"left_push", 0.0}};
  question.joints = {{"left_elbow", 0.0, 0.0}};
  const auto answer = ask(scene, question);
  ASSERT_TRUE(std::holds_alternative<std::string>(answer));
  EXPECT_NE(std::get<std::string>(answer).find("\"left_elbow\""), std::string::npos);
}

TEST(AssumedMotion, ACarriedRobotComesNearerByTheSpeedOfItsCarrier) {
  const Scene scene = arm_on_a_cart(", max_speed: 0.05");
  Question question = test::swing(0.0, 0.0);
  question.tolerance = 1e-9;
  question.poses = {{.object = "cart", .world_from_object = {.position = {0, 0.4, 0}}}};
  question.poses[0].age = 0.5;
  question.poses[0].turn_speed = 0.0;
  const double now = 2.9 - 0.15 - 2.3 - 0.05;  // the finger in front of the post
  EXPECT_NEAR(answered(scene, question).lower, now - 0.05 * 2.5, 1e-6) << "of 2 s and its age";
  question.poses[0].turn_speed = 0.01;
  const Answer turning = answered(scene, question);
  EXPECT_LT(turning.lower, now - 0.05 * 2.5 - 0.01 * 2.5 * 2.3 + 1e-9);
  question.poses[0].turn_speed = kInfinity;
  EXPECT_EQ(answered(scene, question).margins[0].verdict, Verdict::kBelow) << "it may turn round";
  question.others = OthersMove::kNot;
  EXPECT_NEAR(answered(scene, question).lower, now, 1e-6);
}

// The posture at an instant is asked for by itself, with the cart where it is then.
TEST(AssumedMotion, ARobotGoesWhereItsCarrierIsStatedToGo) {
  const Scene scene = arm_on_a_cart("", ", {between: [arm, cart]}");
  std::mt19937_64 engine(4);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  };
  int near = 0;
  Asker asker(scene);
  for (int round = 0; round < 25; ++round) {
    Question question = test::swing(between(-1.0, 1.0), between(-1.0, 1.0));
    question.others = OthersMove::kNot;
    question.tolerance = 1e-6;
    ObjectMotion cart{.object = "cart", .times = {0.2, 0.9, 2.5}, .world_from_object = {}};
    std::vector<double> angles;
    for (int i = 0; i < 3; ++i) {
      angles.push_back(between(-1.0, 1.0));
      cart.world_from_object.push_back(
          {.position = {between(-0.8, 1.2), between(-1.0, 1.0), 0.0},
           .orientation = Eigen::Quaterniond(Eigen::AngleAxisd(angles.back(), Vec3::UnitZ()))});
    }
    question.moving = {cart};
    const Answer answer = answered(scene, question);
    EXPECT_LE(answer.upper - answer.lower, 1e-6);
    double least = 1e300;
    for (int i = 0; i <= 100; ++i) {
      const double t = 0.02 * i;
      Question posture = test::swing(0.0, 0.0);
      const auto& ends = question.motion.positions;
      posture.motion.times = {0.0};
      posture.motion.positions = {ends[0] + (ends[1] - ends[0]) * t / 2.0};
      posture.others = OthersMove::kNot;
      const std::size_t row = t < 0.9 ? 0 : 1;
      const double u =
          std::clamp((t - cart.times[row]) / (cart.times[row + 1] - cart.times[row]), 0.0, 1.0);
      const auto& poses = cart.world_from_object;
      const double angle = angles[row] + u * (angles[row + 1] - angles[row]);
      posture.poses = {
          {.object = "cart",
           .world_from_object = {
               .position =
                   poses[row].position + u * (poses[row + 1].position - poses[row].position),
               .orientation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec3::UnitZ()))}}};
      posture.tolerance = 1e-12;
      Answer there;
      ASSERT_FALSE(asker.ask(posture, there));
      least = std::min(least, there.upper);
    }
    EXPECT_LE(answer.lower, least + 1e-12) << round;
    EXPECT_GE(answer.lower, least - 0.05) << round;
    near += least < 0.3 ? 1 : 0;
  }
  EXPECT_GT(near, 3);
}

}  // namespace
}  // namespace clearance::assumed_motion_test
