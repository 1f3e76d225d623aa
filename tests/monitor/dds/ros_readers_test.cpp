// Joint states and transforms of ROS 2 as the tick thread receives them, through DDS on loopback.
// The interpretation of their bytes is tested without DDS in intake/.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "monitor/dds/pose_reader.hpp"
#include "monitor/wire/convert.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/ros_frames.hpp"
#include "tests/shared/ros_joints.hpp"

namespace clearance {
namespace {

using testing::HasSubstr;

// The positions in a batch, by the names of the cell.
using Positions = std::map<std::string, double>;

class RosReadersTest : public testing::Test {
 protected:
  // Waits for the next batch.
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

  Cell cell{test::two_scara_arms()};
  Scene& scene = cell.scene;
  DdsOptions dds = test::own_dds();
  Participant daemon{dds}, robot{dds};
  PoseReader inputs{cell, daemon};

  RosReadersTest() { inputs.start(); }
};

TEST_F(RosReadersTest, ComeInAnyOrderInPartAndWithNamesThatTheCellDoesNotHave) {
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
              HasSubstr("1 publisher, of joints that the cell does not have: wheel"));
}

TEST_F(RosReadersTest, OfOneInstantAreWhatOurOwnTopicSays) {
  test::RosJoints joints(robot);
  const dds_entity_t own = robot.writer(TopicKind::kJointStates, cell.topics.joint_states);
  ASSERT_TRUE(joints.is_heard() &&
              test::eventually([&] { return test::matched_readers(own) > 0; }));
  const std::int64_t now = dds_time();
  joints.send_at(now, {"right_shoulder", "right_elbow"}, {0.1, 0.2}, {0.3, 0.4});
  PoseBatch from_ros = next();
  const auto sample = make_joint_states(from_ros, scene);
  ASSERT_EQ(dds_write(own, &*sample), DDS_RETCODE_OK);
  EXPECT_TRUE(test::eventually([&] { return !inputs.refused_sources().empty(); }));
  EXPECT_EQ(next().source.view(), "/joint_states#2") << "a writer that uses the name of another";
  EXPECT_EQ(inputs.refused_sources().size(), 1u);
}

TEST_F(RosReadersTest, StandBeforeAnyPublisherAndLoseNoMessageOfTheFirst) {
  EXPECT_TRUE(
      test::have_readers(robot, dds.partition, {"rt/joint_states", "rt/left/joint_states"}));
  test::RosJoints joints(robot);
  ASSERT_TRUE(joints.is_heard());
  joints.send({"right_push"}, {0.1});
  EXPECT_EQ(positions(next()), (Positions{{"right_push", 0.1}}));
}

TEST_F(RosReadersTest, OfARobotThatStatesItsStopSayTheyAreStopping) {
  const Cell stopping = test::two_stopping_arms();
  PoseReader reader(stopping, daemon);
  reader.start();
  test::RosJoints joints(robot);
  const dds_entity_t stated = robot.ros_writer(kRosBool, ros_dds_name("/left/stopping"));
  ASSERT_TRUE(joints.is_heard() &&
              test::eventually([&] { return test::matched_readers(stated) > 0; }));
  Sample<std_msgs_msg_dds__Bool_> brakes;
  brakes->data = true;
  const auto is_stopping = [&] {
    EXPECT_EQ(dds_write(stated, &*brakes), DDS_RETCODE_OK);
    joints.send({"left_push", "left_shoulder"}, {0.1, 0.2});
    const PoseBatch* const came = reader.next();
    return came != nullptr && came->joints.size() == 2 && came->joints[0].stopping &&
           came->joints[1].stopping;
  };
  EXPECT_TRUE(test::eventually(is_stopping));
}

// The publishers were there, and not read, before the cell named their topics.
TEST_F(RosReadersTest, OfTopicsThatAChangedCellNamesAreHeard) {
  Cell first = test::two_stopping_arms(), later = first;
  for (Robot& arm : first.scene.robots) arm.stopping.stated_on.clear();
  later.scene.robots[0].joint_states = "/left/joints";
  PoseReader reader(first, daemon);
  reader.start();
  test::RosJoints others(robot), joints(robot, "rt/left/joints");
  const dds_entity_t stated = robot.ros_writer(kRosBool, ros_dds_name("/left/stopping"));
  ASSERT_TRUE(others.is_heard());
  ASSERT_TRUE(test::eventually([&] {
    others.send({"right_push"}, {0.1});
    return reader.next() != nullptr;
  }));
  EXPECT_EQ(test::matched_readers(stated), 0);
  reader.change(later);
  Sample<std_msgs_msg_dds__Bool_> brakes;
  brakes->data = true;
  EXPECT_TRUE(test::eventually([&] {
    EXPECT_EQ(dds_write(stated, &*brakes), DDS_RETCODE_OK);
    joints.send({"push", "shoulder"}, {0.1, 0.2});
    const PoseBatch* const came = reader.next();
    return came != nullptr && came->joints.size() == 2 && came->joints[0].stopping;
  }));
}

TEST_F(RosReadersTest, ThatNobodySendsAreSaidToBeMissingWithWhatIsThere) {
  EXPECT_THAT(inputs.senders_of_joints(), HasSubstr("there is no publisher of"));
  EXPECT_THAT(inputs.senders_of_joints(), HasSubstr("domain " + std::to_string(*dds.domain)));
  const dds_entity_t tf = robot.ros_writer(kRosTf, "rt/tf");
  EXPECT_GT(tf, 0);
  EXPECT_TRUE(test::eventually(
      [&] { return inputs.senders_of_joints().find("rt/tf") != std::string::npos; }));
  test::RosJoints joints(robot);
  ASSERT_TRUE(joints.is_heard());
  EXPECT_TRUE(test::eventually(
      [&] { return inputs.senders_of_joints().find("no publisher") == std::string::npos; }));
}

TEST_F(RosReadersTest, OnATopicOfAnotherNameAreNamedAndNotSaidToBeOutOfReach) {
  test::RosJoints joints(robot, "rt/joint_statez");
  const dds_entity_t service = robot.ros_writer(kRosTf, "rq/node/get_parametersRequest");
  EXPECT_GT(service, 0);
  EXPECT_TRUE(test::eventually([&] {
    return inputs.senders_of_joints().find("rt/joint_statez has joint states, and is not read") !=
           std::string::npos;
  }));
  EXPECT_EQ(inputs.senders_of_joints().find("rq/"), std::string::npos);
}

TEST_F(RosReadersTest, OfAnotherPartitionAreNamed) {
  DdsOptions elsewhere = dds;
  elsewhere.partition = "elsewhere";
  Participant ros(elsewhere);
  test::RosJoints joints(ros);
  EXPECT_TRUE(test::eventually([&] {
    return inputs.senders_of_joints().find("published in partition elsewhere and does not reach") !=
           std::string::npos;
  }));
}

TEST_F(RosReadersTest, EndpointsCarryTheHashOfTheirType) {
  const dds_entity_t reader = daemon.ros_reader(kRosJointState, "rt/hash/joint_states");
  test::RosJoints joints(robot, "rt/hash/joint_states");
  ASSERT_TRUE(joints.is_heard());
  joints.send({"a"}, {0.0});
  const std::vector<std::uint64_t> writers = writers_of(reader);
  ASSERT_EQ(writers.size(), 1u);
  EXPECT_EQ(writer_facts(reader, writers[0]).user_data,
            "typehash=RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e;");
}

// A publisher of tf_static that started before the daemon is heard as well. Its transforms are
// repeated, because a value that never changes must not become late.
TEST(RosReaders, TransformsComeFromBothTopicsWhicheverWasThereFirst) {
  Cell cell{test::cell_of({test::moving("cart", {test::ball(0.1)})})};
  cell.scene.objects[0].frame = "cart_link";
  cell.scene.objects[0].age_limit_ns = 60'000'000;
  const DdsOptions dds = test::own_dds();
  Participant daemon(dds), robot(dds);
  test::RosFrames fixed(robot, test::RosFrames::Kind::kStatic);
  fixed.send({{"cart", "cart_link", {0, 0, 1}}});
  PoseReader inputs(cell, daemon);
  inputs.start();
  test::RosFrames frames(robot);
  ASSERT_TRUE(frames.is_heard() && fixed.is_heard());
  const auto comes_to = [&](const Vec3& place) {
    return test::eventually([&] {
      const PoseBatch* const came = inputs.next();
      return came != nullptr && came->samples.at(0).world_from_object.position == place;
    });
  };
  EXPECT_TRUE(comes_to({0, 0, 1}));
  frames.send({{"map", "cart", {3, 0, 0}}});
  EXPECT_TRUE(comes_to({3, 0, 1}));
}

TEST(RosReaders, OfTransformsStandBeforeAnyPublisherWhereTheCellNeedsThem) {
  Cell cell{test::cell_of({test::moving("cart", {test::ball(0.1)})})};
  const DdsOptions dds = test::own_dds();
  Participant daemon(dds), robot(dds);
  {
    PoseReader inputs(cell, daemon);
    inputs.start();
    EXPECT_TRUE(test::have_readers(robot, dds.partition, {cell.topics.poses}));
    EXPECT_FALSE(test::types_read(robot, dds.partition).contains("rt/tf"));
  }
  cell.scene.objects[0].frame = "cart_link";
  PoseReader inputs(cell, daemon);
  inputs.start();
  EXPECT_TRUE(test::have_readers(robot, dds.partition, {"rt/tf", "rt/tf_static"}));
  test::RosFrames fixed(robot, test::RosFrames::Kind::kStatic);
  fixed.send({{"map", "cart_link", {0, 0, 1}}});
  EXPECT_TRUE(test::eventually([&] {
    const PoseBatch* const came = inputs.next();
    return came != nullptr && came->samples.at(0).world_from_object.position == Vec3(0, 0, 1);
  })) << "the reader that stood before hears it";
}

}  // namespace
}  // namespace clearance
