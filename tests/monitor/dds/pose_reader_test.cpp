// The poses topic as the tick thread reads it, through real DDS on loopback.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

#include "monitor/dds/dds_log.hpp"
#include "monitor/dds/pose_reader.hpp"
#include "monitor/publish/health.hpp"
#include "monitor/wire/convert.hpp"
#include "tests/monitor/recording/ros_bags.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/byte_writer.hpp"
#include "tests/shared/child_process.hpp"
#include "tests/shared/logged.hpp"
#include "tests/shared/loopback.hpp"

namespace clearance {
namespace {

Scene two_movers() {
  return test::cell_of(
      {test::moving("a", {test::ball(0.1)}), test::moving("b", {test::ball(0.1)})});
}

class Sender {
 public:
  Sender(const Cell& cell, const DdsOptions& dds, std::string_view source, std::size_t room = 4096)
      : participant_(dds),
        writer_(participant_.writer(TopicKind::kPoses, cell.topics.poses)),
        sample_(make_batch(room)) {
    batch_.source = SourceName(source);
  }

  [[nodiscard]] dds_entity_t writer() const { return writer_; }
  void rename(std::string_view source) { batch_.source = SourceName(source); }
  void send(std::uint64_t sequence_number, std::size_t poses = 1) {
    batch_.sequence_number = sequence_number;
    batch_.samples.assign(poses, test::sample(1, test::at(0, 0, 1), test::kStart));
    to_wire(batch_, *sample_);
    ASSERT_EQ(dds_write(writer_, &*sample_), DDS_RETCODE_OK);
  }

 private:
  Participant participant_;
  dds_entity_t writer_;
  PoseBatch batch_;
  Sample<clearance_msg_PoseBatch> sample_;
};

// Returns the numbers of the next `count` batches.
std::vector<std::uint64_t> take(PoseReader& poses, std::size_t count) {
  std::vector<std::uint64_t> numbers;
  EXPECT_TRUE(test::eventually([&] {
    while (const PoseBatch* batch = poses.next()) numbers.push_back(batch->sequence_number);
    return numbers.size() >= count;
  })) << "only "
      << numbers.size() << " of " << count << " batches came";
  return numbers;
}

struct Port {
  Cell cell{two_movers()};
  Scene& scene = cell.scene;
  DdsOptions dds = test::own_dds();
  Participant participant{dds};
  PoseReader poses{cell, participant};

  Port() { poses.start(); }
  void wait_for(const Sender& sender) {
    ASSERT_TRUE(test::eventually([&] { return test::matched_readers(sender.writer()) == 1; }));
  }
};

TEST(PoseReader, HandsEveryBatchOverInOrder) {
  Port port;
  Sender sender(port.cell, port.dds, "arm");
  port.wait_for(sender);
  std::vector<std::uint64_t> sent, came;
  constexpr auto kBurst = static_cast<std::uint64_t>(topic(TopicKind::kPoses).reader_depth);
  for (std::uint64_t round = 0; round < 160 / kBurst; ++round) {
    for (std::uint64_t i = 1; i <= kBurst; ++i) {
      sent.push_back(kBurst * round + i);
      sender.send(sent.back());
    }
    for (const std::uint64_t number : take(port.poses, kBurst)) came.push_back(number);
  }
  EXPECT_EQ(came, sent);
  const auto tallies = port.poses.tallies();
  ASSERT_EQ(tallies.size(), 1u);
  EXPECT_EQ(tallies[0].source.view(), "arm");
  EXPECT_EQ(tallies[0].batches, 160u);
  EXPECT_EQ(tallies[0].lost, 0u);
}

TEST(PoseReader, KeepsThePosesAsTheyWereSent) {
  Port port;
  Sender sender(port.cell, port.dds, "arm");
  port.wait_for(sender);
  sender.send(1, 3);
  const PoseBatch* batch = nullptr;
  ASSERT_TRUE(test::eventually([&] { return (batch = port.poses.next()) != nullptr; }));
  ASSERT_EQ(batch->samples.size(), 3u);
  EXPECT_EQ(batch->samples[2].object, 1u);
  EXPECT_EQ(batch->samples[2].stamp_ns, test::kStart);
  EXPECT_EQ(batch->samples[2].world_from_object.position, Vec3(0, 0, 1));
}

TEST(PoseReader, CountsGapsInTheNumbersButNotANewStartAsLoss) {
  Port port;
  Sender sender(port.cell, port.dds, "arm");
  port.wait_for(sender);
  for (const std::uint64_t number : {5, 6, 9, 1, 2}) {
    sender.send(number);
    EXPECT_EQ(take(port.poses, 1), std::vector<std::uint64_t>{number});
  }
  EXPECT_EQ(port.poses.tallies().at(0).lost, 2u);
}

TEST(PoseReader, CutsABatchThatIsTooLargeForTheCell) {
  Port port;
  Sender sender(port.cell, port.dds, "arm");
  port.wait_for(sender);
  const std::size_t room = PoseReader::samples_a_batch(port.cell);
  sender.send(1, room + 5);
  sender.send(2, 1);
  const PoseBatch* batch = nullptr;
  ASSERT_TRUE(test::eventually([&] { return (batch = port.poses.next()) != nullptr; }));
  EXPECT_EQ(batch->samples.size(), room);
  ASSERT_TRUE(test::eventually([&] { return (batch = port.poses.next()) != nullptr; }));
  EXPECT_EQ(batch->samples.size(), 1u);
  EXPECT_EQ(port.poses.tallies().at(0).cut_poses, 5u);
}

TEST(PoseReader, KeepsSourcesApartAndRefusesOneTooMany) {
  Port port;
  std::vector<std::unique_ptr<Sender>> senders;
  for (std::size_t i = 0; i <= kMaxSources; ++i) {
    senders.push_back(
        std::make_unique<Sender>(port.cell, port.dds, "source" + std::to_string(i), 4));
    port.wait_for(*senders.back());
    senders.back()->send(100 + i, 3);
    if (i == kMaxSources) break;
    EXPECT_EQ(take(port.poses, 1), std::vector<std::uint64_t>{100 + i});
  }
  EXPECT_TRUE(test::eventually([&] { return !port.poses.refused_sources().empty(); }));
  const auto health = make_health(port.scene, LoopStatistics(port.scene), port.poses, 0);
  ASSERT_EQ(health->rejected._length, 1u);
  EXPECT_STREQ(health->rejected._buffer[0].object, "source 'source16'");
  EXPECT_STREQ(health->rejected._buffer[0].cause, "one source too many");
  EXPECT_EQ(health->rejected._buffer[0].count, 3u);
  EXPECT_EQ(port.poses.tallies().size(), kMaxSources);
  EXPECT_EQ(port.poses.next(), nullptr);
}

// The health topic's count for one cause, summed over all objects and sources.
std::uint64_t refused(const Port& port, std::string_view cause) {
  const auto health = make_health(port.scene, LoopStatistics(port.scene), port.poses, 0);
  std::uint64_t count = 0;
  for (std::uint32_t i = 0; i < health->rejected._length; ++i) {
    if (cause == health->rejected._buffer[i].cause) count += health->rejected._buffer[i].count;
  }
  return count;
}

// Batches of the second writer have numbers above 1,968,000,000.
TEST(PoseReader, LeavesANameToItsFirstWriterUntilThatOneLeaves) {
  Port port;
  auto first = std::make_unique<Sender>(port.cell, port.dds, "arm");
  Sender second(port.cell, port.dds, "arm");
  port.wait_for(*first);
  port.wait_for(second);
  first->send(1);
  EXPECT_EQ(take(port.poses, 1), std::vector<std::uint64_t>{1});
  for (std::uint64_t i = 2; i <= 10; ++i) {
    second.send(1'968'000'000 + i);
    first->send(i);
    const std::vector<std::uint64_t> both = take(port.poses, 2);
    EXPECT_EQ(std::ranges::count(both, i), 1) << i;
  }
  EXPECT_TRUE(test::eventually([&] { return refused(port, "another writer's name") == 9; }));
  EXPECT_EQ(port.poses.tallies().at(0).lost, 0u);

  first.reset();
  std::vector<std::uint64_t> taken;
  EXPECT_TRUE(test::eventually([&] {
    second.send(2'000'000'000);
    while (const PoseBatch* batch = port.poses.next()) taken.push_back(batch->sequence_number);
    return !taken.empty();
  }));
  EXPECT_EQ(port.poses.tallies().at(0).lost, 0u);
}

TEST(PoseReader, StoresNoMoreThanSixteenNamesOfAWriterAndStillHearsOthers) {
  Port port;
  Sender hostile(port.cell, port.dds, "name0", 4), arm(port.cell, port.dds, "arm", 4);
  port.wait_for(hostile);
  port.wait_for(arm);
  arm.send(1);
  EXPECT_EQ(take(port.poses, 1), std::vector<std::uint64_t>{1});
  for (std::uint64_t i = 0; i < 1000; ++i) {
    hostile.rename("name" + std::to_string(i));
    hostile.send(1);
  }
  EXPECT_TRUE(test::eventually([&] { return port.poses.refused_names() >= 1000 - kMaxSources; }));
  EXPECT_EQ(refused(port, "batches of a writer with too many names"), 1000 - kMaxSources);
  arm.send(2);
  std::vector<std::uint64_t> heard;
  EXPECT_TRUE(test::eventually([&] {
    while (const PoseBatch* batch = port.poses.next()) {
      if (batch->source.view() == "arm") heard.push_back(batch->sequence_number);
    }
    return !heard.empty();
  }));
  EXPECT_EQ(heard, std::vector<std::uint64_t>{2});
}

constexpr const char* kDomain = "CLEARANCE_TEST_DOMAIN";
constexpr const char* kPartition = "CLEARANCE_TEST_PARTITION";

// This is not a separate test: it runs in the process that the test below starts. It sends samples
// that end after their key, under the topic and type names of the poses.
TEST(PoseReader, DISABLED_SendsWhatCannotBeDecoded) {
  const char* domain = std::getenv(kDomain);
  if (domain == nullptr) GTEST_SKIP() << "started by another test only";
  const Cell cell{two_movers()};
  const std::string partition = std::getenv(kPartition);
  Participant participant(
      {.domain = static_cast<std::uint32_t>(std::atoi(domain)), .partition = partition});
  const auto source = test::RosCdr().text("garbage").bytes();
  test::ByteWriter cut(participant, partition, clearance_msg_PoseBatch_desc, cell.topics.poses,
                       source);
  ASSERT_TRUE(cut.is_heard());
  for (int i = 0; i < 100; ++i) cut.send();
  dds_wait_for_acks(cut.writer(), DDS_SECS(10));
}

TEST(PoseReader, CountsWhatCannotBeDecodedInHealth) {
  route_dds_log();
  Port port;
  ::setenv(kDomain, std::to_string(*port.dds.domain).c_str(), 1);
  ::setenv(kPartition, port.dds.partition.c_str(), 1);
  test::ChildProcess sender("/proc/self/exe",
                            {"--gtest_also_run_disabled_tests",
                             "--gtest_filter=PoseReader.DISABLED_SendsWhatCannotBeDecoded"});
  EXPECT_TRUE(
      test::eventually([&] { return port.poses.undecodable() == 100; }, std::chrono::seconds(20)))
      << port.poses.undecodable() << sender.output();
  EXPECT_EQ(make_health(port.scene, LoopStatistics(port.scene), port.poses, 0)->undecodable_samples,
            port.poses.undecodable());
  EXPECT_EQ(sender.wait(), 0) << sender.output();
  EXPECT_EQ(port.poses.next(), nullptr);
}

TEST(PoseReader, DropsAndCountsWhatNoTickTakes) {
  Port port;
  Sender sender(port.cell, port.dds, "arm");
  port.wait_for(sender);
  for (std::uint64_t i = 1; i <= PoseReader::kBatches + 10; ++i) {
    sender.send(i);
    ASSERT_TRUE(test::eventually([&] {
      const auto tallies = port.poses.tallies();
      return !tallies.empty() && tallies[0].last_sequence == i;
    }));
  }
  EXPECT_EQ(port.poses.tallies().at(0).lost, 10u);
  EXPECT_EQ(take(port.poses, PoseReader::kBatches).size(), PoseReader::kBatches);
}

// A driver was there before the daemon, which takes longer to start than the ring lasts.
TEST(PoseReader, CountsNothingAsLostThatCameBeforeItsStart) {
  const Cell cell{two_movers()};
  const DdsOptions dds = test::own_dds();
  Participant participant(dds);
  PoseReader poses(cell, participant);
  Sender sender(cell, dds, "arm");
  ASSERT_TRUE(test::eventually([&] { return test::matched_readers(sender.writer()) == 1; }));
  std::uint64_t number = 0;
  while (number < 2 * PoseReader::kBatches) {
    sender.send(++number);
    dds_sleepfor(DDS_MSECS(1));  // a thread that takes samples would take each of them
  }
  poses.start();
  // The samples that wait come one by one, the newest last.
  std::uint64_t last = 0;
  EXPECT_TRUE(test::eventually([&] {
    while (const PoseBatch* batch = poses.next()) last = batch->sequence_number;
    return last == number;
  })) << last;
  sender.send(++number);
  EXPECT_EQ(take(poses, 1), std::vector<std::uint64_t>{number});
  EXPECT_EQ(poses.tallies().at(0).lost, 0u);
}

TEST(PoseReader, RefusesASourceWithoutANameAndNamesTheRefusal) {
  const auto logged = std::make_shared<test::Logged>();
  const test::LoggedTo log(logged);
  Port port;
  Sender sender(port.cell, port.dds, "");
  port.wait_for(sender);
  sender.send(1, 3);
  EXPECT_TRUE(test::eventually([&] { return refused(port, "a source without a name") == 3; }));
  EXPECT_TRUE(test::eventually([&] { return logged->has("[source-refused]"); })) << logged->text();
  const auto health = make_health(port.scene, LoopStatistics(port.scene), port.poses, 0);
  EXPECT_STREQ(health->rejected._buffer[0].object, "source (no name)");
  EXPECT_EQ(port.poses.next(), nullptr);
}

TEST(PoseReader, TellsAWriterWithOtherQosFromOneWithAnotherType) {
  const auto logged = std::make_shared<test::Logged>();
  const test::LoggedTo log(logged);
  Port port;
  Participant robot(port.dds);
  const auto topic = [&](const dds_topic_descriptor_t& type) {
    return check_dds(
        dds_create_topic(robot.handle(), &type, port.cell.topics.poses.c_str(), nullptr, nullptr),
        "topic");
  };
  dds_qos_t* const qos = dds_create_qos();
  dds_qset_partition1(qos, port.dds.partition.c_str());
  const dds_entity_t publisher = dds_create_publisher(robot.handle(), qos, nullptr);
  dds_delete_qos(qos);
  dds_qos_t* const best_effort = dds_create_qos();
  dds_qset_reliability(best_effort, DDS_RELIABILITY_BEST_EFFORT, 0);
  check_dds(dds_create_writer(publisher, topic(clearance_msg_PoseBatch_desc), best_effort, nullptr),
            "writer");
  dds_delete_qos(best_effort);
  EXPECT_TRUE(test::eventually([&] { return logged->has("[incompatible-writer]"); }));
  EXPECT_FALSE(logged->has("[other-type-writer]")) << logged->text();
}

TEST(PoseReader, HearsNothingFromAnotherPartition) {
  Port port;
  DdsOptions elsewhere = port.dds;
  elsewhere.partition += "-elsewhere";
  Sender stranger(port.cell, elsewhere, "stranger");
  Sender sender(port.cell, port.dds, "arm");
  port.wait_for(sender);
  stranger.send(1);
  sender.send(2);
  EXPECT_EQ(take(port.poses, 1), std::vector<std::uint64_t>{2});
  EXPECT_EQ(test::matched_readers(stranger.writer()), 0u);
  EXPECT_EQ(port.poses.tallies().size(), 1u);
}

}  // namespace
}  // namespace clearance
