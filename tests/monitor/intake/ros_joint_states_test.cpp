// What real joint states of ROS 2 are like, as the tick thread gets them, through DDS on loopback.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "monitor/dds/pose_reader.hpp"
#include "monitor/wire/convert.hpp"
#include "tests/monitor/scara_cell.hpp"
#include "tests/shared/ros_joints.hpp"

namespace clearance {
namespace {

using testing::HasSubstr;
using testing::Not;

// The positions that a batch carries, by the names of the cell.
using Positions = std::map<std::string, double>;

class RosJointStatesTest : public testing::Test {
 protected:
  // The next batch that comes.
  PoseBatch next() {
    PoseBatch batch;
    EXPECT_TRUE(test::eventually([&] {
      const PoseBatch* came = inputs.next();
      if (came != nullptr) batch = *came;
      return came != nullptr;
    }));
    return batch;
  }
  Positions positions(const PoseBatch& batch) const {
    Positions found;
    for (const JointSample& sample : batch.joints) {
      found[scene.variables.at(sample.variable).name] = sample.position;
    }
    return found;
  }

  static Scene two_arms() {
    const test::ScratchFolder folder;
    test::write_text(folder / "scara.urdf", test::kScaraUrdf);
    return scene_of(
        "name: test\nunits: {length: m, angle: rad}\nrobots:\n"
        "  - {name: left, urdf: scara.urdf, prefix: left_, joint_states: /left/joint_states}\n"
        "  - {name: right, urdf: scara.urdf, prefix: right_, base: {pose: {xyz: [9, 0, 0]}}, "
        "stamps: sent}\n"
        "pairs: [{between: [left, right]}]\n",
        folder / "cell.yaml");
  }

  Scene scene = two_arms();
  DdsOptions dds = test::own_dds();
  Participant daemon{dds}, robot{dds};
  PoseReader inputs{scene, daemon};
};

TEST_F(RosJointStatesTest, ComeInAnyOrderInPartAndWithNamesThatTheCellDoesNotHave) {
  test::RosJoints joints(robot);
  ASSERT_TRUE(joints.is_heard());
  const std::int64_t now = dds_time();
  joints.send_at(now, {"wheel", "right_push", "right_shoulder"}, {9.0, 0.1, -0.5}, {7.0, 0.2, 0.3});
  const PoseBatch batch = next();
  EXPECT_EQ(batch.source.view(), "/joint_states");
  EXPECT_EQ(batch.sequence_number, 1u);
  EXPECT_EQ(positions(batch), (Positions{{"right_push", 0.1}, {"right_shoulder", -0.5}}));
  EXPECT_EQ(batch.joints[0].velocity, 0.2);
  EXPECT_TRUE(batch.joints[0].has_velocity);
  EXPECT_THAT(inputs.senders_of_joints(),
              HasSubstr("of joints that the cell does not have: wheel"));
}

TEST_F(RosJointStatesTest, OfANamespaceThatARobotNamesNeedNoPrefix) {
  test::RosJoints left(robot, "rt/left/joint_states"), other(robot, "rt/cell/joint_states");
  ASSERT_TRUE(left.is_heard() && other.is_heard());
  left.send({"shoulder", "left_elbow", "right_elbow"}, {0.1, 0.2, 0.3});
  EXPECT_EQ(positions(next()), (Positions{{"left_shoulder", 0.1}, {"left_elbow", 0.2}}));
  // And only there: names of another topic are those of the other robots.
  other.send({"left_shoulder", "shoulder", "right_shoulder"}, {0.4, 0.5, 0.6});
  EXPECT_EQ(positions(next()), (Positions{{"right_shoulder", 0.6}}));
}

TEST_F(RosJointStatesTest, OfSeveralPublishersOfATopicHaveNamesOfTheirOwn) {
  test::RosJoints arm(robot);
  ASSERT_TRUE(arm.is_heard());
  arm.send({"right_shoulder"}, {0.1});
  EXPECT_EQ(next().source.view(), "/joint_states");
  {
    test::RosJoints gripper(robot);
    ASSERT_TRUE(gripper.is_heard());
    gripper.send({"right_push"}, {0.1});
    EXPECT_EQ(next().source.view(), "/joint_states#2");
  }
  ASSERT_TRUE(test::eventually([&] { return inputs.senders_of_joints().starts_with("1 "); }));
  // One that is started again gets the name of the one before.
  test::RosJoints again_gripper(robot);
  ASSERT_TRUE(again_gripper.is_heard());
  again_gripper.send({"right_push"}, {0.1});
  EXPECT_EQ(next().source.view(), "/joint_states#2");
  arm.send({"right_shoulder"}, {0.2});
  const PoseBatch again = next();
  EXPECT_EQ(again.source.view(), "/joint_states");
  EXPECT_EQ(again.sequence_number, 2u);
}

TEST_F(RosJointStatesTest, WithoutPositionsSayNothingAndWithTooFewAreRefusedByTheTick) {
  test::RosJoints joints(robot);
  ASSERT_TRUE(joints.is_heard());
  joints.send({"right_shoulder"}, {}, {1.0});
  EXPECT_TRUE(next().joints.empty());
  joints.send({"right_shoulder", "right_elbow"}, {0.5}, {0.1});
  const PoseBatch batch = next();
  ASSERT_EQ(batch.joints.size(), 2u);
  EXPECT_EQ(batch.joints[0].position, 0.5);
  EXPECT_TRUE(std::isnan(batch.joints[1].position));
  EXPECT_FALSE(batch.joints[0].has_velocity) << "one velocity of two joints is nobody's";
}

// Of a stamp that is none, and for robots that want it: when the message was sent.
TEST_F(RosJointStatesTest, AreStampedWhenTheySayOrWhenTheyWereSent) {
  test::RosJoints left(robot, "rt/left/joint_states"), right(robot);
  ASSERT_TRUE(left.is_heard() && right.is_heard());
  const std::int64_t before = dds_time();
  left.send_at(before - 5'000'000, {"shoulder"}, {0.1});
  EXPECT_EQ(next().joints.at(0).stamp_ns, before - 5'000'000);
  left.send_at(0, {"shoulder"}, {0.1});
  EXPECT_GE(next().joints.at(0).stamp_ns, before);
  right.send_at(12'340'000'000, {"right_elbow"}, {0.1});
  const std::int64_t stamp = next().joints.at(0).stamp_ns;
  EXPECT_GE(stamp, before);
  EXPECT_LE(stamp, dds_time());
}

TEST_F(RosJointStatesTest, OfOneInstantAreWhatOurOwnTopicSays) {
  test::RosJoints joints(robot);
  const dds_entity_t own = robot.writer(TopicKind::kJointStates, scene.topics.joint_states);
  ASSERT_TRUE(joints.is_heard() &&
              test::eventually([&] { return test::matched_readers(own) > 0; }));
  const std::int64_t now = dds_time();
  joints.send_at(now, {"right_shoulder", "right_elbow"}, {0.1, 0.2}, {0.3, 0.4});
  PoseBatch from_ros = next();
  const auto sample = make_joint_states(from_ros, scene);
  ASSERT_EQ(dds_write(own, &*sample), DDS_RETCODE_OK);
  EXPECT_TRUE(test::eventually([&] { return !inputs.refused_sources().empty(); }));
  EXPECT_EQ(inputs.next(), nullptr) << "the name belongs to the writer that sent first";
  EXPECT_EQ(inputs.refused_sources().size(), 1u);
}

TEST_F(RosJointStatesTest, ThatNobodySendsAreSaidToBeMissingWithWhatIsThere) {
  EXPECT_THAT(inputs.senders_of_joints(), HasSubstr("there is no publisher of"));
  EXPECT_THAT(inputs.senders_of_joints(), HasSubstr("domain " + std::to_string(dds.domain)));
  const dds_entity_t tf = robot.ros_writer(kRosTf, "rt/tf");
  EXPECT_GT(tf, 0);
  EXPECT_TRUE(test::eventually(
      [&] { return inputs.senders_of_joints().find("rt/tf") != std::string::npos; }));
  test::RosJoints joints(robot);
  ASSERT_TRUE(joints.is_heard());
  EXPECT_TRUE(test::eventually(
      [&] { return inputs.senders_of_joints().find("no publisher") == std::string::npos; }));
}

// A cell in a partition does not hear ROS 2, which knows the default one only.
TEST_F(RosJointStatesTest, OfAnotherPartitionAreNamed) {
  DdsOptions elsewhere = dds;
  elsewhere.partition = "elsewhere";
  Participant ros(elsewhere);
  test::RosJoints joints(ros);
  EXPECT_TRUE(test::eventually([&] {
    return inputs.senders_of_joints().find("published in partition elsewhere and does not reach") !=
           std::string::npos;
  }));
}

// As ROS 2's tools look for.
TEST_F(RosJointStatesTest, EndpointsCarryTheHashOfTheirType) {
  const dds_entity_t reader = daemon.ros_reader(kRosJointState, "rt/hash/joint_states");
  test::RosJoints joints(robot, "rt/hash/joint_states");
  ASSERT_TRUE(joints.is_heard());
  joints.send({"a"}, {0.0});
  const std::vector<std::uint64_t> writers = writers_of(reader);
  ASSERT_EQ(writers.size(), 1u);
  EXPECT_EQ(writer_facts(reader, writers[0]).user_data,
            "typehash=RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e;");
}

}  // namespace
}  // namespace clearance
