// clearance-robot moves the robots that a cell defines by URDF. The shipped cell of two such arms
// is tested from joint states to distances.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "config/write/single_robot_cell.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

const std::string kArms = test::places::sources() + "/config/cells/seven_joint_arms.yaml";
const std::string kArm = test::places::sources() + "/config/cells/seven_joint_arm/arm.urdf";

// Returns true if every published pair of a report is known and on time.
bool all_known(const clearance_msg_Distances& report) {
  return report.unknown == 0 && report.stale == 0;
}

class RobotJoints : public testing::Test {
 protected:
  // Runs a robot with these arguments on `cell`, which a daemon watches, until everything is known.
  void moves(const std::vector<std::string>& cell, const Cell& read,
             const std::vector<std::string>& arguments) {
    Distances distances(client, read);
    ChildProcess daemon(kDaemon, with(cell, dds_arguments(dds)));
    distances.settle();
    ChildProcess robot(kRobot, with(with(cell, dds_arguments(dds)), arguments));
    EXPECT_TRUE(eventually([&] {
      const auto report = distances.next();
      return report != nullptr && all_known(**report);
    })) << daemon.output()
        << robot.output();
    robot.signal(SIGTERM);
    EXPECT_EQ(robot.wait(), 0);
    EXPECT_TRUE(robot.wrote("joint states sent, 0 failed")) << robot.output();
    daemon.signal(SIGTERM);
    EXPECT_EQ(daemon.wait(), 0);
    EXPECT_FALSE(daemon.told("refused")) << daemon.output();
  }

  DdsOptions dds = own_dds();
  Participant client{dds};
};

// An age limit that a busy machine can meet.
const std::vector<std::string> kSlow = {"--age-limit-ms", "2000"};

TEST_F(RobotJoints, OfTheShippedArmsSwingThroughTheirRanges) {
  const ScratchFolder folder;
  std::string text = read_text(kArms);
  text.insert(text.find("objects:"), "defaults: {age_limit_ms: 2000}\n");
  std::filesystem::copy(std::filesystem::path(kArms).parent_path() / "seven_joint_arm",
                        folder / "seven_joint_arm");
  write_text(folder / "cell.yaml", text);
  moves({folder / "cell.yaml"}, std::get<Cell>(read_cell(folder / "cell.yaml")), {"--rate", "200"});
}

TEST_F(RobotJoints, OfAUrdfAreSentAsRos2Does) {
  moves(with({"--urdf", kArm}, kSlow), std::get<Cell>(read_single_robot({.urdf = kArm})),
        {"--rate", "200", "--ros", "/joint_states"});
}

TEST_F(RobotJoints, AreSentOnTheTopicOfRos2WhereNoneIsNamed) {
  moves(with({"--urdf", kArm}, kSlow), std::get<Cell>(read_single_robot({.urdf = kArm})),
        {"--rate", "200", "--ros"});
  ChildProcess swallowed(kRobot, {"--ros", kArms});
  EXPECT_EQ(swallowed.wait(), 2);
  EXPECT_TRUE(swallowed.wrote("the cell stands before --ros")) << swallowed.output();
}

TEST_F(RobotJoints, FollowALog) {
  const ScratchFolder folder;
  write_text(folder / "joints.csv", "t_ns,joint4,other,joint1\n0,0.1,9,0\n20000000000,0.2,9,1\n");
  moves(with({"--urdf", kArm}, kSlow), std::get<Cell>(read_single_robot({.urdf = kArm})),
        {"--rate", "200", "--joints", folder / "joints.csv"});
}

TEST_F(RobotJoints, OfALogThatIsWrongAreRefused) {
  const ScratchFolder folder;
  write_text(folder / "no_joint.csv", "t_ns,elbow\n0,0.1\n");
  write_text(folder / "no_number.csv", "t_ns,joint1\n0,0.1\n10,x\n");
  ChildProcess no_joint(kRobot, {"--urdf", kArm, "--joints", folder / "no_joint.csv"});
  EXPECT_EQ(no_joint.wait(), 3);
  EXPECT_TRUE(no_joint.wrote("found no joint of the cell")) << no_joint.output();
  ChildProcess no_number(kRobot, {"--urdf", kArm, "--joints", folder / "no_number.csv"});
  EXPECT_EQ(no_number.wait(), 3);
  EXPECT_TRUE(no_number.wrote("no_number.csv:3: ")) << no_number.output();
}

}  // namespace
}  // namespace clearance::test
