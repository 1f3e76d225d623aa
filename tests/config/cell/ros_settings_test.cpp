// The settings of a cell for ROS 2: topics to write and frames to follow.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/config/cells.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/mistake_at.hpp"

namespace clearance {
namespace {

using test::mistake_at;

TEST(RosSettingsOfACell, NameTopicsOrTakeTheStandardOnes) {
  const Cell cell =
      read_good(cell_text("ros2: {markers: true, diagnostics: false, minimum_distance: "
                          "/left/minimum, markers_hz: 10}\n" +
                          kBoxes));
  EXPECT_EQ(cell.ros.outputs.markers, "/clearance/markers");
  EXPECT_EQ(cell.ros.outputs.diagnostics, "");
  EXPECT_EQ(cell.ros.outputs.minimum_distance, "/left/minimum");
  EXPECT_EQ(cell.ros.outputs.speed_scaling, "");
  EXPECT_EQ(cell.ros.markers_hz, 10.0);
  EXPECT_EQ(cell.ros.world(), "world");
}

TEST(RosSettingsOfACell, NameTrajectoriesAndTheirMarginsInUnitsOfTheCell) {
  const std::string keys =
      "ros2: {trajectories: [/arm/joint_trajectory, true], trajectory_margins: [0, 20]}\n";
  const Cell cell = read_good("name: cell\nunits: {length: mm, angle: deg}\n" + keys +
                              "objects:\n  - {name: a, sphere: {radius: 100}}\n"
                              "  - {name: b, fixed: true, sphere: {radius: 100}}\n"
                              "pairs: [{between: [a, b]}]\n");
  EXPECT_THAT(cell.ros.trajectories.topics,
              testing::ElementsAre("/arm/joint_trajectory", "/joint_trajectory"));
  EXPECT_THAT(cell.ros.trajectories.margins, testing::ElementsAre(0.0, 0.02));
  EXPECT_THAT(read_good(cell_text(kBoxes)).ros.trajectories, RosTrajectories{});
  EXPECT_THAT(errors_of(cell_text("ros2: {trajectories: [/a, /a]}\n" + kBoxes)),
              mistake_at("cell.yaml:4:7", "'/a'"));
  EXPECT_THAT(errors_of(cell_text("ros2: {trajectory_margins: [-1]}\n" + kBoxes)),
              mistake_at("cell.yaml:4:29", "-1"));
  EXPECT_THAT(errors_of(cell_text("ros2: {trajectory_margins: []}\n" + kBoxes)),
              mistake_at("cell.yaml:4:28", "no margin"));
}

TEST(RosSettingsOfACell, AreRefusedWhereRos2WouldRefuseThem) {
  for (const char* topic : {"markers", "/", "/a/", "/a//b", "/1a", "/a/1", "/a-b", "/a b"}) {
    EXPECT_THAT(errors_of(cell_text(std::string("ros2: {markers: '") + topic + "'}\n" + kBoxes)),
                mistake_at("cell.yaml:4:17", topic))
        << topic;
  }
  EXPECT_THAT(errors_of(cell_text("ros2: {markers: /a, diagnostics: /a}\n" + kBoxes)),
              mistake_at("cell.yaml:4:7", "'/a'", "'markers'", "'diagnostics'"));
  EXPECT_THAT(
      errors_of(cell_text("ros2: {messages: /a, minimum_distance: /a/distances}\n" + kBoxes)),
      mistake_at("cell.yaml:4:7", "'/a/distances'", "'minimum_distance'", "'messages'"));
  EXPECT_THAT(errors_of(cell_text("ros2: {marker: true}\n" + kBoxes)),
              mistake_at("cell.yaml:4:8", "'marker'", "'markers'"));
  EXPECT_THAT(errors_of(cell_text("ros2: {stamps: never}\n" + kBoxes)),
              mistake_at("cell.yaml:4:16", "'never'"));
  EXPECT_THAT(errors_of(cell_text("ros2: {use_sim_time: gazebo}\n" + kBoxes)),
              mistake_at("cell.yaml:4:22", "'gazebo'"));
}

TEST(RosSettingsOfACell, DeclareTheGroupOfWhatMoveItAdds) {
  const auto cell = [](const std::string& ros, const std::string& rules) {
    return cell_text("ros2: {" + ros + "}\n" + kBoxes + rules);
  };
  const std::string rule = "  - {between: [arm, moveit]}\n";
  const std::string zone =
      "zones: [{name: near, between: [arm, moveit], enter_below: 1, leave_above: 2}]\n";
  const Cell good = read_good(cell("planning_scene: true, collision_object: /a/b", rule + zone));
  EXPECT_EQ(good.ros.moveit.planning_scene, "/planning_scene");
  EXPECT_EQ(good.ros.moveit.collision_object, "/a/b");
  EXPECT_TRUE(good.ros.moveit.attached_collision_object.empty());
  EXPECT_EQ(good.scene.pairs.size(), 2u);
  EXPECT_TRUE(good.scene.zones[0].pairs.empty());
  EXPECT_THAT(errors_of(cell("planning_scene: true", "")), mistake_at("cell.yaml:4:7", "'moveit'"));
  EXPECT_THAT(
      errors_of(cell("planning_scene: true, moveit_group: left", "  - {between: [arm, left]}\n")),
      mistake_at("cell.yaml:4:7", "'left'"));
  EXPECT_THAT(errors_of(cell("world_frame: map", rule)), mistake_at("cell.yaml:11:21", "'moveit'"));
  EXPECT_THAT(errors_of(cell("planning_scene: /a, collision_object: /a", rule)),
              mistake_at("cell.yaml:4:7", "'/a'"));
}

TEST(RosSettingsOfACell, SayWhichFramesThingsFollow) {
  const std::string boxes =
      "objects:\n  - {name: box, frame: /box_link, sphere: {radius: 1}}\n"
      "  - {name: floor, fixed: true, half_space: {normal: [0, 0, 1], offset: 0}}\n"
      "pairs: [{between: [box, floor]}]\n";
  const Cell cell = read_good(cell_text("ros2: {world_frame: map}\n" + boxes));
  EXPECT_EQ(cell.scene.objects[0].frame, "box_link");
  EXPECT_EQ(cell.ros.world(), "map");
  EXPECT_THAT(errors_of(cell_text(boxes)),
              mistake_at("cell.yaml:1:1", "'box'", "'box_link'", "world_frame"));
  EXPECT_THAT(errors_of(cell_text("ros2: {world_frame: map}\nobjects:\n  - {name: floor, fixed: "
                                  "true, frame: a, half_space: {normal: [0, 0, 1], offset: 0}}\n"
                                  "pairs: []\n")),
              mistake_at("cell.yaml:6:39", "'frame'"));
}

// The root is connected by a floating joint that the URDF does not contain. Everything else stays
// the same.
TEST(RosSettingsOfACell, FloatTheBaseOfARobotThatFollowsAFrame) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  const auto cell = [](const std::string& base) {
    return "name: test\nunits: {length: m, angle: rad}\nros2: {world_frame: map}\n"
           "robots: [{name: arm, urdf: scara.urdf, prefix: r_, source: driver, base: " +
           base + "}]\npairs: [{between: [arm, arm]}]\n";
  };
  const Scene plain = scene_of(cell("{}"), folder / "cell.yaml");
  const Scene scene = scene_of(cell("{frame: mir, age_limit_ms: 500, pose: {xyz: [0, 0, 1]}}"),
                               folder / "cell.yaml");
  const Robot& robot = scene.robots.at(0);
  EXPECT_EQ(robot.base.frame, "mir");
  EXPECT_EQ(robot.base.frame_from_root.position, Vec3(0, 0, 1));
  EXPECT_EQ(robot.base.base_from_root.position, Vec3(0, 0, 0));
  ASSERT_EQ(robot.joints.size(), 4u);
  EXPECT_EQ(robot.joints[0].type, JointType::kFloating);
  EXPECT_EQ(robot.links[1].name, "r_foot");
  ASSERT_EQ(scene.variables.size(), 10u);
  EXPECT_EQ(scene.variables[0].name, "r_arm_base/trans_x");
  EXPECT_EQ(scene.variables[0].age_limit_ns, 500'000'000);
  EXPECT_EQ(scene.variables[0].source, "");
  EXPECT_TRUE(robot.is_of_base(6));
  EXPECT_FALSE(robot.is_of_base(7));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(scene.variables[7 + i].name, plain.variables[i].name);
    EXPECT_EQ(scene.variables[7 + i].source, "driver");
    EXPECT_EQ(robot.joints[1 + i].name, plain.robots[0].joints[i].name);
    EXPECT_EQ(robot.joints[1 + i].parent, plain.robots[0].joints[i].parent + 1);
  }
  EXPECT_TRUE(plain.objects[0].fixed) << "the foot";
  EXPECT_FALSE(scene.objects[0].fixed);
  EXPECT_THAT(errors_of(cell("{frame: mir, on: r_foot}"), folder / "cell.yaml"),
              mistake_at("cell.yaml:4:91", "'on'"));
}

}  // namespace
}  // namespace clearance
