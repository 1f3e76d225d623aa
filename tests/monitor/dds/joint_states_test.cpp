// The topic of joint states as the tick thread reads it, through real DDS on loopback.
#include <gtest/gtest.h>

#include "monitor/dds/pose_reader.hpp"
#include "monitor/wire/convert.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/loopback.hpp"

namespace clearance {
namespace {

// A robot that sends joints and poses to the reader of a daemon.
class JointStatesReader : public testing::Test {
 protected:
  void SetUp() override {
    inputs.start();
    ASSERT_TRUE(test::eventually(
        [&] { return test::matched_readers(joints) == 1 && test::matched_readers(poses) == 1; }));
  }
  void send_joints(const PoseBatch& batch) const {
    const Sample<clearance_msg_JointStates> sample = make_joint_states(batch, scene);
    ASSERT_EQ(dds_write(joints, &*sample), DDS_RETCODE_OK);
  }
  // Sends the pose of the object that no joint moves.
  void send_pose(const char* source) const {
    PoseBatch batch{SourceName(source), 1, scene.revision, {}};
    batch.samples.push_back(test::sample(1, test::at(0, 0, 1), test::kStart));
    Sample<clearance_msg_PoseBatch> sample = make_batch(1);
    to_wire(batch, *sample);
    ASSERT_EQ(dds_write(poses, &*sample), DDS_RETCODE_OK);
  }

  const Cell cell{test::scara_cell()};
  const Scene& scene = cell.scene;
  const DdsOptions dds = test::own_dds();
  Participant daemon{dds}, robot{dds};
  PoseReader inputs{cell, daemon};
  const dds_entity_t joints = robot.writer(TopicKind::kJointStates, cell.topics.joint_states);
  const dds_entity_t poses = robot.writer(TopicKind::kPoses, cell.topics.poses);
};

TEST_F(JointStatesReader, HandsJointsOverBesidePosesOfOtherSources) {
  const auto states = test::joints(0.1, 0.2, 0.15, test::kStart);
  PoseBatch batch{SourceName("arm"), 1, 0, {}};
  batch.joints.assign(states.begin(), states.end());
  send_joints(batch);
  send_pose("cart");

  int batches = 0;
  EXPECT_TRUE(test::eventually([&] {
    while (const PoseBatch* came = inputs.next()) {
      ++batches;
      if (came->source.view() == "cart") {
        EXPECT_EQ(came->samples.size(), 1u);
        EXPECT_TRUE(came->joints.empty());
        continue;
      }
      EXPECT_EQ(came->source.view(), "arm");
      EXPECT_TRUE(came->samples.empty());
      EXPECT_EQ(came->joints.size(), 3u);
      if (came->joints.size() == 3) {
        EXPECT_EQ(came->joints[2].position, 0.15);
      }
    }
    return batches >= 2;
  }));
  EXPECT_EQ(inputs.tallies().size(), 2u);
}

// A source name belongs to one writer across both topics, because batches are identified by name
// and number.
TEST_F(JointStatesReader, AWriterOfPosesThatUsesTheNameOfOneOfJointsGetsAnother) {
  PoseBatch batch{SourceName("arm"), 1, 0, {}};
  batch.joints.push_back(test::joint(0, 0.1, test::kStart));
  send_joints(batch);
  ASSERT_TRUE(test::eventually([&] { return inputs.next() != nullptr; }));
  send_pose("arm");
  EXPECT_TRUE(test::eventually([&] { return inputs.refused_sources().size() == 1; }));
  const PoseBatch* const other = inputs.next();
  ASSERT_NE(other, nullptr);
  EXPECT_EQ(other->source.view(), "arm#2");
}

}  // namespace
}  // namespace clearance
