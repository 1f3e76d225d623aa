// Joint states as messages: which joint a name means on which topic, and what comes of positions.
//
// Oracle: tables, and for messages of three entries the definition: of two different positions of
// one joint, none is meant.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "monitor/wire/convert.hpp"
#include "tests/shared/every_choice.hpp"

namespace clearance::test {
namespace {

constexpr std::uint32_t kUnusedJoint = JointNames::kUnused, kUnknownJoint = JointNames::kUnknown;

// A left arm on a topic of its own, whose second joint is not read, and a right arm. Each has a
// joint that is no variable. The left arm also has one without a name of its own.
Scene scene_of_two_arms() {
  Scene scene;
  scene.robots.resize(2);
  scene.robots[0].prefix = "left_";
  scene.robots[0].joint_states = "/left/joint_states";
  scene.robots[1].prefix = "right_";
  for (const auto& [name, robot, is_read] :
       {std::tuple("left_a", 0u, true), {"left_b", 0u, false}, {"right_a", 1u, true}}) {
    JointVariable& variable = scene.variables.emplace_back();
    variable.name = name;
    variable.robot = robot;
    variable.is_read = is_read;
  }
  for (const char* name : {"left_a", "left_b", "left_fixed", "left_"})
    scene.robots[0].joints.emplace_back().name = name;
  for (const char* name : {"right_a", "right_mimic"})
    scene.robots[1].joints.emplace_back().name = name;
  return scene;
}

TEST(JointNames, MeanAJointByTopicWithItsPrefixOrWithout) {
  struct Row {
    const char* name;
    std::uint32_t on_ours, on_left, on_others;
  };
  constexpr Row kRows[] = {
      {"left_a", 0, 0, kUnknownJoint},
      {"left_b", kUnusedJoint, kUnusedJoint, kUnknownJoint},
      {"left_fixed", kUnusedJoint, kUnusedJoint, kUnknownJoint},
      {"right_a", 2, kUnknownJoint, 2},
      {"right_mimic", kUnusedJoint, kUnknownJoint, kUnusedJoint},
      {"a", kUnknownJoint, 0, kUnknownJoint},
      {"b", kUnknownJoint, kUnusedJoint, kUnknownJoint},
      {"fixed", kUnknownJoint, kUnusedJoint, kUnknownJoint},
      {"left_", kUnknownJoint, kUnknownJoint, kUnknownJoint},
      {"", kUnknownJoint, kUnknownJoint, kUnknownJoint},
  };
  const Scene scene = scene_of_two_arms();
  const JointNames ours(scene), left(scene, "/left/joint_states"), others(scene, "/joint_states");
  for (const Row& row : kRows) {
    EXPECT_EQ(ours.find(row.name), row.on_ours) << row.name;
    EXPECT_EQ(left.find(row.name), row.on_left) << row.name;
    EXPECT_EQ(others.find(row.name), row.on_others) << row.name;
  }
}

// A joint of a message, with its values.
struct MessageEntry {
  std::string name;
  double position;
};

Sample<clearance_msg_JointStates> own_message(const std::vector<MessageEntry>& entries) {
  Sample<clearance_msg_JointStates> message;
  message->stamp_ns = 77;
  reserve_sequence(message->names, entries.size());
  reserve_sequence(message->positions, entries.size());
  for (const MessageEntry& entry : entries) {
    message->names._buffer[message->names._length++] = dds_string_dup(entry.name.c_str());
    message->positions._buffer[message->positions._length++] = entry.position;
  }
  return message;
}
Sample<sensor_msgs_msg_dds__JointState_> ros_message(const std::vector<MessageEntry>& entries) {
  Sample<sensor_msgs_msg_dds__JointState_> message;
  reserve_sequence(message->name, entries.size());
  reserve_sequence(message->position, entries.size());
  for (const MessageEntry& entry : entries) {
    message->name._buffer[message->name._length++] = dds_string_dup(entry.name.c_str());
    message->position._buffer[message->position._length++] = entry.position;
  }
  return message;
}

struct KnownJoint {
  std::uint32_t variable;
  double position;
};
void expect_joints(const std::vector<KnownJoint>& expected, const std::vector<JointSample>& found) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].variable, expected[i].variable);
    EXPECT_EQ(found[i].stamp_ns, 77);
    EXPECT_TRUE(found[i].position == expected[i].position ||
                (std::isnan(found[i].position) && std::isnan(expected[i].position)))
        << found[i].position << ", expected " << expected[i].position;
  }
}

// The tick refuses what is not finite.
TEST(JointMessages, OfThreeEntriesSayOfAJointItsOnePositionOrNone) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  constexpr const char* kNames[] = {"left_a", "right_a", "left_b", "wheel"};
  const std::uint32_t kVariables[] = {0, 2, kUnusedJoint, kUnknownJoint};
  constexpr double kPositions[] = {0.1, 0.2, kNone};
  Scene scene = scene_of_two_arms();
  scene.robots[0].joint_states.clear();
  const JointNames ours(scene), of_ros(scene, "/joint_states");
  EveryChoice choice;
  while (choice.next()) {
    std::vector<MessageEntry> entries;
    std::vector<KnownJoint> all;
    for (int i = 0; i < 3; ++i) {
      const std::size_t name = choice.of(std::size(kNames));
      const double position = kPositions[choice.of(std::size(kPositions))];
      entries.push_back({kNames[name], position});
      all.push_back({kVariables[name], position});
    }
    std::vector<KnownJoint> by_ours, by_ros;
    for (const KnownJoint& one : all) {
      if (one.variable == kUnusedJoint) continue;
      const bool is_one =
          one.variable == kUnknownJoint || std::ranges::all_of(all, [&](auto& other) {
            return other.variable != one.variable || other.position == one.position;
          });
      by_ours.push_back({one.variable, is_one ? one.position : kNone});
      if (one.variable != kUnknownJoint) by_ros.push_back(by_ours.back());
    }
    PoseBatch batch;
    from_wire(*own_message(entries), ours, batch);
    expect_joints(by_ours, batch.joints);
    from_wire(*ros_message(entries), of_ros, 77, batch);
    expect_joints(by_ros, batch.joints);
    ASSERT_FALSE(testing::Test::HasFailure()) << "run " << choice.runs();
  }
  EXPECT_EQ(choice.runs(), 12u * 12u * 12u);
}

// A list of another length says of no joint whose its velocities are.
TEST(JointMessages, HaveVelocitiesIfThereIsOneForEachName) {
  const Scene scene = scene_of_two_arms();
  const std::vector<MessageEntry> entries = {{"right_a", 0.1}, {"right_mimic", 0.2}};
  for (const std::uint32_t count : {0u, 1u, 2u, 3u}) {
    auto ours = own_message(entries);
    auto of_ros = ros_message(entries);
    reserve_sequence(ours->velocities, 3);
    reserve_sequence(of_ros->velocity, 3);
    ours->velocities._buffer[0] = of_ros->velocity._buffer[0] = -3.0;
    ours->velocities._length = of_ros->velocity._length = count;
    PoseBatch batch;
    from_wire(*ours, JointNames(scene), batch);
    ASSERT_EQ(batch.joints.size(), 1u);
    EXPECT_EQ(batch.joints[0].has_velocity, count == 2);
    EXPECT_EQ(batch.joints[0].velocity, count == 2 ? -3.0 : 0.0);
    from_wire(*of_ros, JointNames(scene, "/"), 77, batch);
    ASSERT_EQ(batch.joints.size(), 1u);
    EXPECT_EQ(batch.joints[0].has_velocity, count == 2);
    EXPECT_EQ(batch.joints[0].velocity, count == 2 ? -3.0 : 0.0);
  }
  PoseBatch batch;
  from_wire(*Sample<clearance_msg_JointStates>(), JointNames(scene), batch);
  EXPECT_TRUE(batch.joints.empty());
}

TEST(PoseMessages, WithOnePoseAndTwoTwistsOfAnObjectHaveNone) {
  for (const double second : {2.0, 0.0}) {
    PoseBatch sent{SourceName("arm"), 1, 0, std::vector<PoseSample>(2)}, received;
    for (PoseSample& sample : sent.samples) sample.has_twist = true;
    sent.samples[0].twist.linear.x() = 2.0;
    sent.samples[1].twist.linear.x() = second;
    auto wire = make_batch(2);
    ASSERT_TRUE(to_wire(sent, *wire));
    from_wire(*wire, received);
    for (const PoseSample& sample : received.samples)
      EXPECT_EQ(sample.world_from_object.position.allFinite(), second == 2.0);
  }
}

TEST(JointMessages, ComeBackBitForBit) {
  const Scene scene = scene_of_two_arms();
  const JointNames names(scene);
  for (const bool has_velocity : {false, true}) {
    for (const bool stopping : {false, true}) {
      PoseBatch sent{SourceName("arm"), 41, 0, {}};
      for (const std::uint32_t variable : {2u, 0u}) {
        JointSample& sample = sent.joints.emplace_back();
        sample.variable = variable;
        sample.stamp_ns = 77;
        sample.position = 0.1 + variable;
        sample.has_velocity = has_velocity;
        sample.velocity = has_velocity ? -0.3 - variable : 0.0;
        sample.stopping = stopping;
      }
      PoseBatch came{SourceName("other"), 1, 2, std::vector<PoseSample>(1)};
      came.joints.resize(3);
      from_wire(*make_joint_states(sent, scene), names, came);
      EXPECT_EQ(came.source.view(), "arm");
      EXPECT_EQ(came.sequence_number, 41u);
      EXPECT_EQ(came.scene_revision, 0u) << "the names say what is meant";
      EXPECT_TRUE(came.samples.empty());
      ASSERT_EQ(came.joints.size(), sent.joints.size());
      for (std::size_t i = 0; i < sent.joints.size(); ++i) {
        EXPECT_EQ(came.joints[i].variable, sent.joints[i].variable);
        EXPECT_EQ(came.joints[i].stamp_ns, 77);
        EXPECT_EQ(came.joints[i].position, sent.joints[i].position);
        EXPECT_EQ(came.joints[i].has_velocity, has_velocity);
        EXPECT_EQ(came.joints[i].velocity, sent.joints[i].velocity);
        EXPECT_EQ(came.joints[i].stopping, stopping);
      }
    }
  }
}

TEST(JointMessages, OfAnEmptyBatchHaveNoNames) {
  const PoseBatch batch{SourceName("arm"), 9, 0, {}};
  const auto message = make_joint_states(batch, scene_of_two_arms());
  EXPECT_EQ(message->names._length, 0u);
  EXPECT_EQ(message->sequence_number, 9u);
}

}  // namespace
}  // namespace clearance::test
