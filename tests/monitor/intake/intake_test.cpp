// Inputs on this project's own topics: which sources are admitted, and what is reported about them.
#include "monitor/intake/intake.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "monitor/wire/convert.hpp"
#include "tests/monitor/intake/heard.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance::test {
namespace {

class IntakeTest : public testing::Test {
 protected:
  // Sends one message on this project's own topic, with this many poses.
  bool take(std::uint64_t number, std::uint64_t writer = 1, std::size_t poses = 1,
            std::string_view source = "arm", std::uint64_t revision = 0) {
    PoseBatch batch{SourceName(source), number, revision, {}};
    batch.samples.assign(poses, sample(0, at(0, 0, 1), heard.now.realtime_ns));
    Sample<clearance_msg_PoseBatch> wire = make_batch(poses);
    to_wire(batch, *wire);
    const std::span<const std::byte> cdr = encoder.encode(*wire);
    return heard.intake.take(
        {.topic = heard.intake.topic(TopicKind::kPoses)->number, .cdr = cdr, .writer = writer},
        heard.now);
  }
  [[nodiscard]] const SourceTally& tally() const { return heard.intake.sources().tallies().at(0); }

  Cell cell{cell_of({moving("ball", {ball(0.1)}), fixed("box", {ball(0.1)}, at(0, 0, 7))})};
  Heard heard{cell, {.admits_sources = true, .most_samples = 8}};
  CdrEncoder encoder;
};

TEST_F(IntakeTest, GivesEveryBatchAsItWasSent) {
  EXPECT_TRUE(take(5, 1, 3));
  const PoseBatch batch = heard.one();
  EXPECT_EQ(batch.source.view(), "arm");
  EXPECT_EQ(batch.sequence_number, 5u);
  ASSERT_EQ(batch.samples.size(), 3u);
  EXPECT_EQ(batch.samples[2].stamp_ns, heard.now.realtime_ns);
  EXPECT_EQ(batch.samples[2].world_from_object.position, Vec3(0, 0, 1));
  EXPECT_EQ(tally().batches, 1u);
}

// Points and maps have one of two types: which, their publisher shows.
TEST(Intake, NamesTheTopicsOfRos2ThatItsCellNames) {
  Cell cell = two_scara_arms();
  Sensor eye, scan;
  eye.topic = "/eye/image";
  eye.camera_info = "/eye/info";
  scan.kind = SensorKind::kPoints;
  scan.topic = "/scan";
  cell.scene.sensors = {eye, scan};
  cell.ros.moveit.collision_object = "/collision_object";
  const auto names = [&cell](IntakeOptions options) {
    std::vector<std::string> found;
    const Heard heard(cell, std::move(options));
    for (const NamedTopic& topic : heard.intake.named()) found.push_back(topic.name);
    return found;
  };
  using testing::UnorderedElementsAre;
  EXPECT_THAT(names({}), UnorderedElementsAre("/left/joint_states", "/joint_states"));
  EXPECT_THAT(names({.use_scene = [](const moveit::RawScene&) {}}),
              UnorderedElementsAre("/left/joint_states", "/joint_states", "/collision_object"));
  EXPECT_THAT(names({.use_sensor = [](const RawSensorMessage&) {}, .only_sensors = true}),
              UnorderedElementsAre("/eye/image", "/eye/info", "/scan", "/tf", "/tf_static"));
}

TEST_F(IntakeTest, KnowsOurTopicsByTheirNamesAndTypes) {
  const auto poses = heard.intake.topic(TopicKind::kPoses);
  const auto joints = heard.intake.topic(TopicKind::kJointStates);
  ASSERT_TRUE(poses && joints);
  EXPECT_NE(poses->number, joints->number);
  EXPECT_EQ(poses->delivery, nullptr);
  EXPECT_EQ(heard.intake.topic(TopicKind::kPoses)->number, poses->number);
  EXPECT_FALSE(heard.intake.topic(TopicKind::kDistances));
  EXPECT_FALSE(heard.intake.topic({cell.topics.poses, "std_msgs/msg/String"}));
}

TEST_F(IntakeTest, CountsWhatIsLostCutAndNotDecodable) {
  take(1);
  take(4);
  EXPECT_EQ(tally().lost, 2u) << "numbers 2 and 3";
  take(5, 1, 20);
  EXPECT_EQ(heard.batches.back().samples.size(), 8u);
  EXPECT_EQ(tally().cut_poses, 12u);
  heard.has_room = false;
  take(6);
  EXPECT_EQ(tally().lost, 3u);
  EXPECT_EQ(tally().batches, 3u);
  const std::uint32_t poses = heard.intake.topic(TopicKind::kPoses)->number;
  EXPECT_FALSE(heard.intake.take({.topic = poses, .cdr = {}}, heard.now));
  EXPECT_EQ(heard.intake.counts(poses).undecodable, 1u);
}

// The tick compares what the two writers say, and trusts neither while they disagree.
TEST_F(IntakeTest, GivesASecondWriterOfANameANameOfItsOwnAndTellsOnceOfEach) {
  take(1, 1);
  take(1, 2);
  take(2, 2);
  const std::vector<PoseBatch> both = heard.all();
  ASSERT_EQ(both.size(), 3u);
  EXPECT_EQ(both[0].source.view(), "arm");
  EXPECT_EQ(both[2].source.view(), "arm#2");
  EXPECT_EQ(heard.intake.sources().refused().at(0).poses, 2u);
  heard.intake.keep({2});
  take(3, 2);
  EXPECT_EQ(heard.one().source.view(), "arm");
  std::vector<std::string_view> codes;
  for (const News& news : heard.intake.take_news()) codes.push_back(news.code);
  EXPECT_EQ(codes, (std::vector{lines::kNewSource.code, lines::kSourceRefused.code,
                                lines::kNewSource.code, lines::kSourceTakenOver.code}));
}

// A third writer is heard as well, since it may contradict the other two. It keeps its name while
// all three send.
TEST_F(IntakeTest, GivesEveryFurtherWriterOfANameANameOfItsOwn) {
  for (std::uint64_t number = 1; number <= 3; ++number) {
    for (const std::uint64_t writer : {1, 2, 3}) take(number, writer);
  }
  const std::vector<PoseBatch> all = heard.all();
  ASSERT_EQ(all.size(), 9u);
  const std::array names{"arm", "arm#2", "arm#3"};
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_EQ(all[i].source.view(), names.at(i % 3)) << i;
  for (const SourceTally& tally : heard.intake.sources().tallies()) EXPECT_EQ(tally.lost, 0u);
}

// The cell does not say which of two writers it means.
TEST_F(IntakeTest, GivesASecondWriterANameOfItsOwnAlsoWhereTheCellStatesTheName) {
  cell.scene.objects[0].source = "arm";
  Heard stated(cell, {.admits_sources = true, .most_samples = 8});
  for (const std::uint64_t writer : {1, 2}) {
    PoseBatch batch{SourceName("arm"), 1, 0, {}};
    batch.samples.push_back(sample(0, at(0, 0, 1), stated.now.realtime_ns));
    Sample<clearance_msg_PoseBatch> wire = make_batch(1);
    to_wire(batch, *wire);
    stated.intake.take({.topic = stated.intake.topic(TopicKind::kPoses)->number,
                        .cdr = encoder.encode(*wire),
                        .writer = writer},
                       stated.now);
  }
  const std::vector<PoseBatch> both = stated.all();
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].source.view(), "arm");
  EXPECT_EQ(both[1].source.view(), "arm#2");
}

TEST_F(IntakeTest, TellsOnceOfASourceWhosePosesAreOfAnotherScene) {
  take(1, 1, 1, "arm", cell.scene.revision + 1);
  take(2, 1, 1, "arm", cell.scene.revision + 1);
  EXPECT_EQ(heard.all().size(), 2u) << "the tick counts them";
  const std::vector<News> news = heard.intake.take_news();
  EXPECT_EQ(std::ranges::count(news, lines::kOtherRevision.code, &News::code), 1);
}

TEST_F(IntakeTest, TellsOnceOfAnInputThatComesTooSeldomForItsAgeLimit) {
  cell.scene.objects[0].age_limit_ns = 20'000'000;
  Heard slow(cell);
  for (std::uint64_t i = 1; i <= 100; ++i) {
    PoseBatch batch{SourceName("camera"), i, 0, {}};
    batch.samples.push_back(
        sample(0, at(0, 0, 1), kStart + static_cast<std::int64_t>(i) * 33'000'000));
    Sample<clearance_msg_PoseBatch> wire = make_batch(1);
    to_wire(batch, *wire);
    slow.intake.take(
        {.topic = slow.intake.topic(TopicKind::kPoses)->number, .cdr = encoder.encode(*wire)},
        slow.now);
  }
  const std::vector<News> news = slow.intake.take_news();
  ASSERT_EQ(news.size(), 1u);
  EXPECT_EQ(news[0].code, lines::kSlowInput.code);
}

// Joints of a robot on this project's own topic.
TEST(IntakeOfJoints, FindsJointsByTheirNames) {
  const Cell cell{scara_cell()};
  Heard heard(cell);
  PoseBatch sent{SourceName("arm"), 7, 0, {}};
  for (const JointSample& each : joints(0.1, 0.2, 0.3, 1000)) sent.joints.push_back(each);
  const auto wire = make_joint_states(sent, cell.scene);
  CdrEncoder encoder;
  EXPECT_TRUE(heard.intake.take(
      {.topic = heard.intake.topic(TopicKind::kJointStates)->number, .cdr = encoder.encode(*wire)},
      heard.now));
  const PoseBatch batch = heard.one();
  EXPECT_EQ(batch.sequence_number, 7u);
  ASSERT_EQ(batch.joints.size(), 3u);
  EXPECT_EQ(batch.joints[1].variable, 1u);
  EXPECT_EQ(batch.joints[1].position, 0.2);
}

TEST(TopicName, OfDdsIsThatOfRosWhereItIsOne) {
  const TopicName tf = as_in_ros("rt/r2/tf", "tf2_msgs::msg::dds_::TFMessage_");
  EXPECT_EQ(tf.name, "/r2/tf");
  EXPECT_EQ(tf.type, "tf2_msgs/msg/TFMessage");
  const TopicName ours = as_in_ros("clearance/poses", "clearance_msg::PoseBatch");
  EXPECT_EQ(ours.name, "clearance/poses");
  EXPECT_EQ(ours.type, "clearance_msg::PoseBatch");
  EXPECT_EQ(as_in_ros("rt/x", "no_ros::Type").name, "rt/x");
}

}  // namespace
}  // namespace clearance::test
