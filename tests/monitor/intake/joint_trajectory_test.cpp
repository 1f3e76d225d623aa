// Messages of trajectory_msgs/JointTrajectory as motions, and those that are none.
//
// The bytes are made by the rules of CDR, without the types of the wire.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "monitor/intake/ros_joint_trajectory.hpp"
#include "tests/monitor/recording/ros_bags.hpp"
#include "tests/monitor/tick/scara_cell.hpp"

namespace clearance {
namespace {

struct PointText {
  double time = 0.0;
  std::vector<double> positions, velocities = {};
};

class JointTrajectories : public testing::Test {
 protected:
  // An arm whose joint states come on /left/joint_states, and one of the same names elsewhere.
  const Scene scene = [] {
    const test::ScratchFolder folder;
    test::write_text(folder / "scara.urdf", test::kScaraUrdf);
    return scene_of(
        "name: test\nunits: {length: m, angle: rad}\nrobots:\n"
        "  - {name: left, prefix: left_, urdf: scara.urdf, joint_states: /left/joint_states}\n"
        "  - {name: right, urdf: scara.urdf, base: {pose: {xyz: [9, 0, 0]}}}\n"
        "pairs: [{between: [left, right]}]\n",
        folder / "cell.yaml");
  }();
  // All joints rest at 0.
  InputState state = [this] {
    InputState all;
    all.joints.assign(scene.variables.size(), {.state = PresentPose::State::kUsable});
    all.joint_ages.assign(scene.variables.size(), 0.0);
    return all;
  }();

  std::variant<JointTrajectory, std::string> made(const std::vector<std::string>& joints,
                                                  const std::vector<PointText>& points,
                                                  const std::string& topic = "/joint_trajectory") {
    test::RosCdr cdr;
    cdr.header(0, "").number(static_cast<std::uint32_t>(joints.size()));
    for (const std::string& joint : joints) cdr.text(joint);
    cdr.number(static_cast<std::uint32_t>(points.size()));
    for (const PointText& point : points) {
      cdr.numbers(point.positions).numbers(point.velocities).numbers({}).numbers({});
      cdr.number(static_cast<std::int32_t>(point.time)).number(std::uint32_t{0});
    }
    return motion_of(topic, cdr.bytes(), CdrBytes::kUnchecked, scene, state);
  }
  std::string refusal(const std::vector<std::string>& joints,
                      const std::vector<PointText>& points) {
    const auto result = made(joints, points);
    const auto* const text = std::get_if<std::string>(&result);
    return text == nullptr ? "" : *text;
  }
  bool is_refused(const std::vector<std::string>& joints, const std::vector<PointText>& points,
                  const std::string& word) {
    return refusal(joints, points).find(word) != std::string::npos;
  }
};

// A controller interpolates each segment by what its two ends state.
TEST_F(JointTrajectories, HaveVelocitiesInAllPointsOrInNone) {
  const std::vector<std::string> joint = {"shoulder"};
  EXPECT_EQ(refusal(joint, {{0, {0}}, {1, {1}}}), "");
  EXPECT_EQ(refusal(joint, {{0, {0}, {0}}, {1, {1}, {0}}}), "");
  EXPECT_TRUE(is_refused(joint, {{0, {0}, {0}}, {1, {1}, {0}}, {2, {1}}}, "points[2]"));
  EXPECT_TRUE(is_refused(joint, {{0, {0}}, {1, {1}, {0}}}, "points[1]"));
  EXPECT_TRUE(is_refused(joint, {{0, {0}, {0, 0}}, {1, {1}, {0, 0}}}, "points[0]"));
}

TEST_F(JointTrajectories, BeginAtRestWhereTheJointsAreOrAreRefused) {
  const std::vector<std::string> joints = {"shoulder", "elbow"};
  const std::vector<PointText> later = {{1, {0.5, 0.0}}};
  EXPECT_EQ(refusal(joints, later), "");
  PresentJoint& shoulder = state.joints[3];
  ASSERT_EQ(scene.variables[3].name, "shoulder");
  for (const double speed : {0.1, -0.1, std::numeric_limits<double>::quiet_NaN()}) {
    shoulder.velocity = speed;
    EXPECT_TRUE(is_refused(joints, later, "'shoulder'")) << speed;
    EXPECT_EQ(refusal(joints, {{0, {0.0, 0.0}}, {1, {0.5, 0.0}}}), "") << "it says where it begins";
  }
  shoulder.velocity = 0.0;
  // A controller turns a continuous joint in the shorter direction.
  EXPECT_EQ(refusal(joints, {{1, {0.5, 3.1}}}), "");
  EXPECT_TRUE(is_refused(joints, {{1, {0.5, 3.2}}}, "'elbow'"));
  EXPECT_TRUE(is_refused(joints, {{1, {0.5, -3.2}}}, "'elbow'"));
}

// Joint states on a topic of a robot have the same rule.
TEST_F(JointTrajectories, NameTheJointsOfTheRobotWhoseNamespaceTheirTopicHas) {
  const auto names_on = [&](const std::string& topic, const std::string& joint) {
    const auto result = made({joint}, {{0, {0}}, {1, {1}}}, topic);
    return std::get<JointTrajectory>(result).joints.at(0);
  };
  EXPECT_EQ(names_on("/left/joint_trajectory", "shoulder"), "left_shoulder");
  EXPECT_EQ(names_on("/left/arm_controller/joint_trajectory", "shoulder"), "left_shoulder");
  EXPECT_EQ(names_on("/left/joint_trajectory", "left_shoulder"), "left_shoulder");
  EXPECT_EQ(names_on("/leftmost/joint_trajectory", "shoulder"), "shoulder");
  EXPECT_EQ(names_on("/joint_trajectory", "shoulder"), "shoulder");
  EXPECT_EQ(names_on("/joint_trajectory", "left_shoulder"), "left_shoulder");
}

}  // namespace
}  // namespace clearance
