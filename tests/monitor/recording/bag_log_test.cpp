// The statements of a bag about a cell's robots and objects, and the limits of such statements.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "monitor/recording/input_log.hpp"
#include "tests/monitor/recording/ros_bags.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/mistake_at.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::int64_t kT = 1'700'000'000'000'000'000;
constexpr std::int64_t kBagMs = 1'000'000;

struct ReadLog {
  std::vector<LoggedBatch> batches;
  std::string error;
  bool readable = true;
  std::vector<std::string> notes;
};

class BagLogTest : public testing::Test {
 protected:
  ReadLog read(const std::vector<RosMessage>& messages, const InputLogOptions& options = {}) {
    write_mcap_bag(folder / "bag.mcap", messages);
    return read_file("bag.mcap", options);
  }
  ReadLog read_file(const std::string& name, const InputLogOptions& options = {}) {
    const std::unique_ptr<InputLog> log = open_input_log(folder / name, cell, options);
    ReadLog all;
    LoggedBatch batch;
    while (log->next(batch)) {
      const bool moves_nothing = batch.batch.empty() && !batch.scene && !batch.sensor;
      if (!moves_nothing) all.batches.push_back(batch);
    }
    all.error = log->error();
    all.readable = log->readable();
    all.notes = log->notes();
    return all;
  }

  ScratchFolder folder;
  Cell cell{scara_cell()};
  Scene& scene = cell.scene;
};

TEST_F(BagLogTest, JointStatesMoveTheJointsOfTheirNamesInAnyOrder) {
  const ReadLog log = read({joint_state(
      kT + 3, kT, {{"push", "shoulder", "elbow"}, {0.1, 0.2, -0.3}, {1, 2, 3}, {NAN, NAN, NAN}})});
  EXPECT_EQ("", log.error);
  ASSERT_EQ(1u, log.batches.size());
  EXPECT_EQ(kT + 3, log.batches[0].log_ns);
  const PoseBatch& batch = log.batches[0].batch;
  EXPECT_EQ("/joint_states", batch.source.view());
  EXPECT_EQ(1u, batch.sequence_number);
  ASSERT_EQ(3u, batch.joints.size());
  EXPECT_EQ(2u, batch.joints[0].variable);
  EXPECT_EQ(0.1, batch.joints[0].position);
  EXPECT_EQ(1.0, batch.joints[0].velocity);
  EXPECT_TRUE(batch.joints[0].has_velocity);
  EXPECT_EQ(0u, batch.joints[1].variable);
  EXPECT_EQ(kT, batch.joints[1].stamp_ns);
  EXPECT_THAT(log.notes, IsEmpty());
}

TEST_F(BagLogTest, ArmAndGripperMayComeByDifferentPublishersAndNamespaces) {
  const ReadLog log = read({joint_state(kT, kT, {{"shoulder", "elbow"}, {0.1, 0.2}}),
                            joint_state(kT + 1, kT, {{"push"}, {0.05}}, "/gripper/joint_states"),
                            joint_state(kT + 2, kT, {{"push"}, {9.0}}, "/joint_commands")});
  ASSERT_EQ(2u, log.batches.size());
  EXPECT_EQ("/gripper/joint_states", log.batches[1].batch.source.view());
  EXPECT_FALSE(log.batches[0].batch.joints[0].has_velocity);
  const ReadLog asked = read({joint_state(kT, kT, {{"push"}, {9.0}}, "/joint_commands"),
                              joint_state(kT, kT, {{"push"}, {0.1}})},
                             {.joint_topics = {"/joint_commands"}});
  ASSERT_EQ(1u, asked.batches.size());
  EXPECT_EQ(9.0, asked.batches[0].batch.joints[0].position);
}

TEST_F(BagLogTest, WhatIsNotUsedIsToldOnceWithItsCount) {
  const ReadLog log = read({joint_state(kT, kT, {{"sholder", "elbow"}, {0.1, 0.2}}),
                            joint_state(kT + 1, kT, {{"sholder", "elbow"}, {0.1, 0.2}}),
                            joint_state(kT + 2, kT, {{"elbow"}, {}, {}, {4.0}}),
                            {"/joint_states", "sensor_msgs/msg/JointState", kT + 3, {}}});
  EXPECT_EQ(2u, log.batches.size());
  EXPECT_THAT(log.notes, Contains(HasSubstr("joint 'sholder' of the bag is not in the cell: left "
                                            "out; did you mean 'shoulder'?")));
  EXPECT_THAT(log.notes, Contains(HasSubstr("1 message of /joint_states had no position")));
  EXPECT_THAT(log.notes, Contains(HasSubstr("1 message of /joint_states did not decode")));
  EXPECT_THAT(log.notes, Contains(HasSubstr("what hangs on them is unknown: shoulder, push; "
                                            "--joint NAME=POSITION")));
}

TEST_F(BagLogTest, OfAListThatIsTooShortTheRestIsNoPosition) {
  const ReadLog log = read({joint_state(kT, kT, {{"shoulder", "elbow"}, {0.1}, {1.0}})});
  ASSERT_EQ(1u, log.batches.size());
  ASSERT_EQ(2u, log.batches[0].batch.joints.size());
  EXPECT_EQ(0.1, log.batches[0].batch.joints[0].position);
  EXPECT_TRUE(std::isnan(log.batches[0].batch.joints[1].position));
  EXPECT_FALSE(log.batches[0].batch.joints[0].has_velocity);
}

TEST_F(BagLogTest, StampsOfZeroAndOfAnotherClockAreReplacedByTheTimeOfRecording) {
  const ReadLog log = read({joint_state(kT, 0, {{"elbow"}, {0.1}}),
                            joint_state(kT + kBagMs, 12 * 1'000'000'000LL, {{"elbow"}, {0.1}}),
                            joint_state(kT + 2 * kBagMs, kT, {{"elbow"}, {0.1}})});
  ASSERT_EQ(3u, log.batches.size());
  EXPECT_EQ(kT, log.batches[0].batch.joints[0].stamp_ns);
  EXPECT_EQ(kT + kBagMs, log.batches[1].batch.joints[0].stamp_ns);
  EXPECT_EQ(kT, log.batches[2].batch.joints[0].stamp_ns);
  EXPECT_THAT(log.notes, Contains(HasSubstr("1 message of /joint_states had no stamp")));
  EXPECT_THAT(log.notes,
              Contains(HasSubstr(
                  "1 message of /joint_states had a stamp of another clock (-1699999988.0 s)")));
}

TEST_F(BagLogTest, MessagesThatStandALittleOutOfOrderArePutInOrder) {
  const ReadLog log = read({joint_state(kT + 5 * kBagMs, kT, {{"elbow"}, {0.5}}),
                            joint_state(kT + 1 * kBagMs, kT, {{"elbow"}, {0.1}}),
                            joint_state(kT + 9'000 * kBagMs, kT, {{"elbow"}, {0.9}}),
                            joint_state(kT + 2 * kBagMs, kT, {{"elbow"}, {0.2}})});
  ASSERT_EQ(4u, log.batches.size());
  const double order[] = {0.1, 0.5, 0.2, 0.9};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(order[i], log.batches[i].batch.joints[0].position);
    if (i > 0) {
      EXPECT_GE(log.batches[i].log_ns, log.batches[i - 1].log_ns);
    }
  }
}

TEST_F(BagLogTest, TransformsMoveTheObjectsOfTheirNames) {
  const double half = std::sqrt(0.5);
  const ReadLog log =
      read({transforms(kT, 0, {{"world", "table", {1, 0, 0}, {0, 0, half, half}}}, "/tf_static"),
            transforms(kT + kBagMs, kT, {{"/table", "cart", {2, 0, 0}}, {"table", "nobody"}}),
            joint_state(kT + kBagMs, kT, {{"shoulder", "elbow", "push"}, {0, 0, 0}})});
  EXPECT_EQ("", log.error);
  ASSERT_EQ(2u, log.batches.size());
  const PoseBatch& batch = log.batches[0].batch;
  EXPECT_EQ("/tf", batch.source.view());
  ASSERT_EQ(1u, batch.samples.size());
  EXPECT_EQ("cart", scene.objects[batch.samples[0].object].name);
  EXPECT_EQ(kT, batch.samples[0].stamp_ns);
  EXPECT_NEAR(0.0, (batch.samples[0].world_from_object.position - Vec3(1, 2, 0)).norm(), 1e-15);
  EXPECT_THAT(log.notes, IsEmpty());
}

// The robot's root link is where the cell places it. Any other root frame is taken as the world.
TEST_F(BagLogTest, FramesHangOnTheRobotsRootOrOnAWorldOfAnotherName) {
  scene = scara_cell(", base: {pose: {xyz: [0, 0, 3]}}");
  const ReadLog on_robot = read({transforms(kT, kT, {{"foot", "cart", {1, 0, 0}}})});
  ASSERT_EQ(1u, on_robot.batches.size());
  EXPECT_EQ(Vec3(1, 0, 3), on_robot.batches[0].batch.samples[0].world_from_object.position);
  const ReadLog on_map = read({transforms(kT, kT, {{"map", "cart", {1, 0, 0}}})});
  EXPECT_EQ(Vec3(1, 0, 0), on_map.batches[0].batch.samples[0].world_from_object.position);
  EXPECT_THAT(on_map.notes, Contains(HasSubstr("frame 'map' is taken to be the cell's world")));
}

// The cell's keys are the same as for live inputs.
TEST_F(BagLogTest, FramesThatTheCellNamesMoveObjectsAndBases) {
  write_text(folder / "scara.urdf", kScaraUrdf);
  cell = read_good(
      "name: test\nunits: {length: m, angle: rad}\nros2: {world_frame: map}\n"
      "robots: [{name: arm, urdf: scara.urdf, base: {frame: mir, pose: {xyz: [0, 0, 1]}}}]\n"
      "objects: [{name: box, frame: box_link, sphere: {radius: 0.1}}]\n"
      "pairs: [{between: [arm, box]}]\n",
      folder / "cell.yaml");
  const ReadLog log = read({transforms(kT, kT, {{"mir", "box_link", {0, 0, 2}}}, "/tf_static"),
                            transforms(kT + kBagMs, kT - kBagMs,
                                       {{"earth", "map", {9, 9, 9}}, {"map", "mir", {1, 0, 0}}})});
  ASSERT_EQ(2u, log.batches.size());
  const PoseBatch& base = log.batches[0].batch;
  EXPECT_EQ("/tf:bases", base.source.view());
  ASSERT_EQ(7u, base.joints.size());
  EXPECT_EQ("arm_base/trans_x", scene.variables[base.joints[0].variable].name);
  EXPECT_EQ(1.0, base.joints[0].position);
  EXPECT_EQ(1.0, base.joints[2].position);
  EXPECT_EQ(1.0, base.joints[6].position);
  EXPECT_EQ(kT - kBagMs, base.joints[6].stamp_ns);
  const PoseBatch& box = log.batches[1].batch;
  EXPECT_EQ("/tf", box.source.view());
  ASSERT_EQ(1u, box.samples.size());
  EXPECT_EQ(Vec3(1, 0, 2), box.samples[0].world_from_object.position);
  EXPECT_EQ(kT - kBagMs, box.samples[0].stamp_ns);
}

TEST_F(BagLogTest, FramesThatGoRoundInACircleMoveNothing) {
  const ReadLog log = read({transforms(kT, kT, {{"cart", "table"}, {"table", "cart"}})});
  EXPECT_THAT(log.batches, IsEmpty());
}

TEST_F(BagLogTest, LinksOfRobotsAreNotTakenFromTransforms) {
  const ReadLog log = read({transforms(kT, kT, {{"world", "upper"}})});
  EXPECT_THAT(log.batches, IsEmpty());
}

TEST_F(BagLogTest, NothingOfUseIsAnErrorThatNamesWhatIsThereInstead) {
  const ReadLog log = read({joint_state(kT, kT, {{"elbow"}, {1}}, "/arm/joint_commands"),
                            ros_text(kT, "hello", "/chatter")});
  EXPECT_THAT(log.error, HasSubstr("bag.mcap has nothing that moves this cell"));
  EXPECT_THAT(log.error, HasSubstr("/arm/joint_commands (sensor_msgs/msg/JointState, 1 message), "
                                   "/chatter (std_msgs/msg/String, 1 message)"));
  EXPECT_THAT(log.error, HasSubstr("--joint-topic"));
}

TEST_F(BagLogTest, TheBagOfAnotherRobotSaysWhoseJointsItHas) {
  const ReadLog log = read({joint_state(kT, kT, {{"panda_joint1"}, {1}})});
  EXPECT_THAT(log.error, HasSubstr("of joints that the cell's robots do not have: panda_joint1; "
                                   "theirs are shoulder, elbow, push"));
}

TEST_F(BagLogTest, JointsThatNobodySendsMayBeGiven) {
  const InputLogOptions given{.joint_topics = {}, .joints = {{"push", 0.07}}};
  const ReadLog log = read({joint_state(kT, kT, {{"shoulder", "elbow"}, {0.1, 0.2}})}, given);
  ASSERT_EQ(2u, log.batches.size());
  EXPECT_EQ("given", log.batches[1].batch.source.view());
  EXPECT_EQ(0.07, log.batches[1].batch.joints[0].position);
  EXPECT_EQ(kT, log.batches[1].log_ns);
  EXPECT_THAT(log.notes, IsEmpty());
  const ReadLog wrong = read({joint_state(kT, kT, {{"shoulder"}, {0.1}})},
                             {.joint_topics = {}, .joints = {{"pusch", 0.07}}});
  EXPECT_FALSE(wrong.readable);
  EXPECT_THAT(wrong.error, HasSubstr("no joint 'pusch' moves in this cell; did you mean 'push'?"));
}

// Messages with numbers of any size and times of any kind.
TEST_F(BagLogTest, HostileMessagesAreSurvived) {
  std::mt19937_64 random(8);
  const std::vector<RosMessage> sound = {
      joint_state(kT, kT, {{"shoulder", "elbow", "push"}, {0.1, 0.2, 0.3}, {1, 2, 3}}),
      transforms(kT, kT, {{"world", "cart"}, {"cart", "table"}}),
      transforms(kT, kT, {{"world", "cart"}}, "/tf_static")};
  std::vector<RosMessage> messages;
  for (int i = 0; i < 3000; ++i) {
    RosMessage message = sound[random() % sound.size()];
    for (std::uint64_t flips = 1 + random() % 6; flips > 0; --flips) {
      message.cdr[random() % message.cdr.size()] = static_cast<std::byte>(random());
    }
    if (i % 4 == 0) message.cdr.resize(random() % message.cdr.size());
    if (i % 5 == 0) message.log_ns = static_cast<std::int64_t>(random());
    messages.push_back(message);
  }
  const ReadLog log = read(messages);
  EXPECT_EQ("", log.error);
  for (std::size_t i = 1; i < log.batches.size(); ++i) {
    EXPECT_GE(log.batches[i].log_ns, log.batches[i - 1].log_ns);
    EXPECT_GE(log.batches[i].log_ns, 0);
  }
}

TEST_F(BagLogTest, JointTableHasAColumnAJoint) {
  write_text(folder / "log.csv",
             "shoulder,t_ns,elbow,push,elbow/velocity,shoulder/velocity,push/velocity,ee_x\n"
             "0.1,5,0.2,0.3,2,1,3,9\n0.4,6,0.5,0.6,2,1,3,9\n");
  EXPECT_TRUE(is_input_log(folder / "log.csv"));
  const ReadLog log = read_file("log.csv");
  EXPECT_EQ("", log.error);
  ASSERT_EQ(2u, log.batches.size());
  const PoseBatch& batch = log.batches[1].batch;
  EXPECT_EQ(6, log.batches[1].log_ns);
  ASSERT_EQ(3u, batch.joints.size());
  EXPECT_EQ(0.4, batch.joints[0].position);
  EXPECT_EQ(1.0, batch.joints[0].velocity);
  EXPECT_EQ(6, batch.joints[0].stamp_ns);
  ASSERT_EQ(1u, log.notes.size());
  EXPECT_THAT(log.notes[0],
              HasSubstr("columns that are no joints of the cell were left out: ee_x"));
}

TEST_F(BagLogTest, MistakesInAJointTableAreToldByLine) {
  const auto error_of = [&](const std::string& text) {
    write_text(folder / "log.csv", text);
    return read_file("log.csv").error;
  };
  EXPECT_THAT(error_of("t_ns,q1,q2\n1,2,3\n"),
              mistake_at("log.csv:1", "'shoulder'", "'elbow'", "'push'"));
  EXPECT_THAT(error_of("t_ns,elbow\n1,2\n2,x\n"), mistake_at("log.csv:3", "elbow", "'x'"));
  EXPECT_THAT(error_of("t_ns,elbow\n2,2\n1,2\n"), mistake_at("log.csv:3", "t_ns"));
  EXPECT_THAT(error_of("t_ns,elbow\n"), HasSubstr("log.csv has no rows"));
  EXPECT_THAT(error_of("elbow\n1\n"), mistake_at("log.csv:1", "'t_ns'"));
}

// The cell changes while the log is read: the joints of another id are those of the person then.
TEST_F(BagLogTest, MessagesAreReadByTheCellThatIsInForceThen) {
  const auto cell_of = [&](const std::string& id) {
    return read_good(
        "name: test\nunits: {length: m, angle: rad}\nros2: {world_frame: map, tracked_bodies: "
        "true}\nrobots: [{name: one, person: {stature: 1.7, error: 0, id: " +
            id +
            "}, groups: [people]}]\n"
            "objects: [{name: post, fixed: true, sphere: {radius: 0.1}}]\n"
            "pairs: [{between: [people, post]}]\n",
        folder / "cell.yaml");
  };
  const Cell before = cell_of("b1"), after = cell_of("b2");
  write_mcap_bag(folder / "bag.mcap",
                 {joint_state(kT, kT, {{"waist_b1", "waist_b2"}, {0.1, 0.2}}),
                  joint_state(kT + 1, kT + 1, {{"waist_b1", "waist_b2"}, {0.3, 0.4}})});
  const auto log = open_input_log(folder / "bag.mcap", before, {.with_scenes = true});
  LoggedBatch batch;
  ASSERT_TRUE(log->next(batch));
  EXPECT_EQ(batch.batch.scene_revision, before.scene.revision);
  ASSERT_EQ(batch.batch.joints.size(), 1u);
  EXPECT_EQ(batch.batch.joints[0].position, 0.1);
  log->change(after);
  ASSERT_TRUE(log->next(batch));
  EXPECT_EQ(batch.batch.scene_revision, after.scene.revision);
  ASSERT_EQ(batch.batch.joints.size(), 1u);
  EXPECT_EQ(batch.batch.joints[0].position, 0.4);
}

TEST_F(BagLogTest, RecordingsOfOursAndPoseLogsAreNoInputLogs) {
  write_text(folder / "poses.csv", "t_ns,object,px,py,pz,qw,qx,qy,qz\n");
  EXPECT_FALSE(is_input_log(folder / "poses.csv"));
  {
    McapWriter ours(folder / "ours.mcap");
    const auto channel = ours.add_channel({"clearance::msg::PoseBatch", "omgidl", ""}, "p", "cdr");
    ours.write(channel, 1, 1, {});
  }
  EXPECT_FALSE(is_input_log(folder / "ours.mcap"));
  EXPECT_FALSE(is_input_log(folder / "none.mcap"));
  write_mcap_bag(folder / "bag.mcap", {ros_text(kT, "x")});
  EXPECT_TRUE(is_input_log(folder / "bag.mcap"));
}

}  // namespace
}  // namespace clearance::test
