// Realistic joint states of ROS 2, and the interpretation of their bytes.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "monitor/wire/cdr.hpp"
#include "monitor/wire/convert.hpp"
#include "tests/monitor/intake/heard.hpp"
#include "tests/monitor/tick/scara_cell.hpp"

namespace clearance::test {
namespace {

// The positions in a batch, by the names of the cell.
using Positions = std::map<std::string, double>;

class RosJointStatesTest : public testing::Test {
 protected:
  // Sends the state, stamped with the current time.
  bool take(const JointStateText& state, const std::string& topic = "/joint_states",
            std::uint64_t writer = 1) {
    return heard.take(joint_state(now(), now(), state, topic), writer);
  }
  Positions positions(const PoseBatch& batch) const {
    Positions found;
    for (const JointSample& sample : batch.joints) {
      found[cell.scene.variables.at(sample.variable).name] = sample.position;
    }
    return found;
  }
  [[nodiscard]] std::int64_t now() const { return heard.now.realtime_ns; }

  Cell cell = two_scara_arms();
  Heard heard{cell};
};

TEST_F(RosJointStatesTest, ComeInAnyOrderInPartAndWithNamesThatTheCellDoesNotHave) {
  ASSERT_TRUE(take({{"wheel", "right_push", "right_shoulder"}, {9.0, 0.1, -0.5}, {7.0, 0.2, 0.3}}));
  const PoseBatch batch = heard.one();
  EXPECT_EQ(batch.source.view(), "/joint_states");
  EXPECT_EQ(batch.sequence_number, 1u);
  EXPECT_EQ(positions(batch), (Positions{{"right_push", 0.1}, {"right_shoulder", -0.5}}));
  EXPECT_EQ(batch.joints[0].velocity, 0.2);
  EXPECT_TRUE(batch.joints[0].has_velocity);
  EXPECT_EQ(heard.intake.joint_states().unknown_names(), (std::set<std::string>{"wheel"}));
  take({{"wheel"}, {1.0}});
  EXPECT_EQ(heard.told(lines::kUnknownJoints.code), 1u) << "each name once";
}

// The tick refuses what is not finite, and the joint ages. Equal positions say nothing else, if
// they have one velocity or none that is known.
TEST_F(RosJointStatesTest, TwoPositionsOfOneJointInOneMessageAreNone) {
  ASSERT_TRUE(take({{"right_push", "right_shoulder", "right_push"}, {0.1, -0.5, 0.2}, {}}));
  const PoseBatch batch = heard.one();
  ASSERT_EQ(batch.joints.size(), 3u);
  EXPECT_TRUE(std::isnan(batch.joints[0].position) && std::isnan(batch.joints[2].position));
  EXPECT_EQ(batch.joints[1].position, -0.5);
  ASSERT_TRUE(take({{"right_push", "right_push"}, {0.1, 0.1}, {}}));
  for (const JointSample& sample : heard.one().joints) EXPECT_EQ(sample.position, 0.1);
  for (const auto& [first, second, is_one] : {std::tuple(2.0, 2.0, true),
                                              {2.0, 0.0, false},
                                              {std::nan(""), std::nan(""), true},
                                              {std::nan(""), 0.0, false}}) {
    ASSERT_TRUE(take({{"right_push", "right_push"}, {0.1, 0.1}, {first, second}}));
    for (const JointSample& sample : heard.one().joints)
      EXPECT_EQ(std::isfinite(sample.position), is_one) << first << ", " << second;
  }

  PoseBatch sent{SourceName("arm"), 1, 0, {}};
  sent.joints = {joint(0, 0.1, now()), joint(1, 0.3, now()), joint(0, 0.2, now())};
  PoseBatch received;
  from_wire(*make_joint_states(sent, cell.scene), JointNames(cell.scene), received);
  ASSERT_EQ(received.joints.size(), 3u);
  EXPECT_TRUE(std::isnan(received.joints[0].position) && std::isnan(received.joints[2].position));
  EXPECT_EQ(received.joints[1].position, 0.3);
}

// The tick refuses such a joint without a name: only the message has it.
TEST_F(RosJointStatesTest, OfOurOwnTopicWithANameThatTheCellDoesNotHaveAreTold) {
  PoseBatch sent{SourceName("arm"), 1, 0, {}};
  sent.joints = {joint(0, 0.1, now())};
  const auto states = make_joint_states(sent, cell.scene);
  dds_string_free(states->names._buffer[0]);
  states->names._buffer[0] = dds_string_dup("left_sholder");
  CdrEncoder encoder;
  const auto bytes = encoder.encode(*states);
  RosMessage message = joint_state(now(), now(), {});
  message.topic = cell.topics.joint_states;
  message.type = topic(TopicKind::kJointStates).type->m_typename;
  message.cdr.assign(bytes.begin(), bytes.end());
  EXPECT_TRUE(heard.take(message));
  EXPECT_TRUE(heard.take(message));
  EXPECT_EQ(heard.told(lines::kUnknownJoints.code), 1u) << "each name once";
}

TEST_F(RosJointStatesTest, OfANamespaceThatARobotNamesNeedNoPrefix) {
  take({{"shoulder", "left_elbow", "right_elbow"}, {0.1, 0.2, 0.3}}, "/left/joint_states");
  EXPECT_EQ(positions(heard.one()), (Positions{{"left_shoulder", 0.1}, {"left_elbow", 0.2}}));
  // The names count only on this topic. On another topic they belong to the other robots.
  take({{"left_shoulder", "shoulder", "right_shoulder"}, {0.4, 0.5, 0.6}}, "/cell/joint_states");
  EXPECT_EQ(positions(heard.one()), (Positions{{"right_shoulder", 0.6}}));
}

TEST_F(RosJointStatesTest, OfOtherTopicsAndTypesAreNotTaken) {
  EXPECT_FALSE(take({{"right_push"}, {0.1}}, "/joint_commands"));
  EXPECT_FALSE(heard.take(ros_text(now(), "hello", "/joint_states")));
  EXPECT_TRUE(heard.batches.empty());
}

TEST_F(RosJointStatesTest, OfSeveralWritersOfATopicHaveNamesOfTheirOwn) {
  take({{"right_shoulder"}, {0.1}}, "/joint_states", 7);
  take({{"right_push"}, {0.1}}, "/joint_states", 8);
  EXPECT_EQ(heard.intake.joint_states().writers(), 2u);
  heard.intake.keep({7});
  EXPECT_EQ(heard.intake.joint_states().writers(), 1u);
  // A publisher that is restarted gets the source name of its predecessor.
  take({{"right_push"}, {0.1}}, "/joint_states", 9);
  take({{"right_shoulder"}, {0.1}}, "/joint_states", 7);
  const std::vector<PoseBatch> batches = heard.all();
  ASSERT_EQ(batches.size(), 4u);
  EXPECT_EQ(batches[0].source.view(), "/joint_states");
  EXPECT_EQ(batches[1].source.view(), "/joint_states#2");
  EXPECT_EQ(batches[2].source.view(), "/joint_states#2");
  EXPECT_EQ(batches[2].sequence_number, 1u);
  EXPECT_EQ(batches[3].source.view(), "/joint_states");
  EXPECT_EQ(batches[3].sequence_number, 2u);
}

TEST_F(RosJointStatesTest, WithoutPositionsSayNothingAndWithTooFewAreRefusedByTheTick) {
  take({{"right_shoulder"}, {}, {1.0}});
  EXPECT_TRUE(heard.one().joints.empty());
  EXPECT_EQ(heard.told(lines::kNoPositions.code), 1u);
  take({{"right_shoulder", "right_elbow"}, {0.5}, {0.1}});
  const PoseBatch batch = heard.one();
  ASSERT_EQ(batch.joints.size(), 2u);
  EXPECT_EQ(batch.joints[0].position, 0.5);
  EXPECT_TRUE(std::isnan(batch.joints[1].position));
  EXPECT_FALSE(batch.joints[0].has_velocity) << "one velocity of two joints is nobody's";
}

// A stamp of 0 means that there is none. Some robots ask to use the time of sending instead.
TEST_F(RosJointStatesTest, AreStampedWhenTheySayOrWhenTheyWereSent) {
  heard.take(joint_state(now(), now() - 5'000'000, {{"shoulder"}, {0.1}}, "/left/joint_states"));
  EXPECT_EQ(heard.one().joints.at(0).stamp_ns, now() - 5'000'000);
  heard.take(joint_state(now(), 0, {{"shoulder"}, {0.1}}, "/left/joint_states"));
  EXPECT_EQ(heard.one().joints.at(0).stamp_ns, now());
  heard.take(joint_state(now(), 12'340'000'000, {{"right_elbow"}, {0.1}}));
  EXPECT_EQ(heard.one().joints.at(0).stamp_ns, now());
}

// Stamps of a simulation's clock, for example. Live, they are used and the user is told once. In a
// log, they are replaced and counted.
TEST_F(RosJointStatesTest, OfAnotherClockAreToldOnceLiveAndReplacedOutOfALog) {
  Heard log(cell, {.is_log = true});
  const RosMessage simulated =
      joint_state(now(), 12'340'000'000, {{"shoulder"}, {0.1}}, "/left/joint_states");
  for (int i = 0; i < 100; ++i) {
    heard.take(simulated);
    log.take(simulated);
    EXPECT_EQ(heard.one().joints.at(0).stamp_ns, 12'340'000'000);
    EXPECT_EQ(log.one().joints.at(0).stamp_ns, now());
    EXPECT_EQ(heard.told(lines::kOtherClock.code),
              i + 1 < StampCheck::kOtherClockMessages ? 0u : 1u);
  }
  const auto topic = log.intake.topic({simulated.topic, simulated.type});
  EXPECT_EQ(log.intake.counts(topic->number).of_another_clock, 100u);
}

TEST_F(RosJointStatesTest, OfMoreTopicsThanAreHeardTheFirstAreTaken) {
  for (std::size_t i = 0; i < RosJointStates::kMostTopics + 9; ++i) {
    const std::string topic = "/robot" + std::to_string(i) + "/joint_states";
    EXPECT_EQ(take({{"right_push"}, {0.1}}, topic), i < RosJointStates::kMostTopics);
  }
  EXPECT_EQ(heard.told(lines::kTooManyTopics.code), 1u);
}

// Each body that a tracker sees has a topic of its own, and many come and go in a day.
TEST_F(RosJointStatesTest, OfATopicWhoseWritersHaveLeftHaveNoPlaceAmongThose) {
  for (std::size_t i = 0; i < 3 * RosJointStates::kMostTopics; ++i) {
    const std::string topic = "/humans/bodies/b" + std::to_string(i) + "/joint_states";
    EXPECT_TRUE(take({{"right_push"}, {0.1}}, topic)) << i;
    EXPECT_TRUE(take({{"right_push"}, {0.1}}, "/humans/bodies/b0/joint_states")) << i;
    heard.intake.keep({});
  }
  EXPECT_EQ(heard.told(lines::kTooManyTopics.code), 0u);
}

TEST_F(RosJointStatesTest, ThatDoNotDecodeAreCountedAndGiveNothing) {
  RosMessage cut = joint_state(now(), now(), {{"right_push"}, {0.1}});
  cut.cdr.resize(cut.cdr.size() / 2);
  EXPECT_FALSE(heard.take(cut));
  EXPECT_TRUE(heard.batches.empty());
  const auto topic = heard.intake.topic({cut.topic, cut.type});
  EXPECT_EQ(heard.intake.counts(topic->number).undecodable, 1u);
  EXPECT_EQ(heard.intake.counts(topic->number).messages, 1u);
}

}  // namespace
}  // namespace clearance::test
