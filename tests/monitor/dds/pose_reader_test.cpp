// The poses topic as the tick thread sees it, through real DDS on loopback.
#include <gtest/gtest.h>

#include "monitor/dds/health.hpp"
#include "monitor/dds/pose_reader.hpp"
#include "monitor/wire/convert.hpp"
#include "tests/monitor/small_cells.hpp"
#include "tests/shared/loopback.hpp"

namespace clearance {
namespace {

Scene two_movers() {
  return test::cell_of(
      {test::moving("a", {test::ball(0.1)}), test::moving("b", {test::ball(0.1)})});
}

LoopStatistics no_statistics(const Scene& scene) {
  LoopStatistics statistics;
  statistics.rejected.resize(scene.objects.size());
  statistics.ages.resize(scene.objects.size());
  return statistics;
}

class Sender {
 public:
  Sender(const Scene& scene, const DdsOptions& dds, std::string_view source,
         std::size_t room = 4096)
      : participant_(dds),
        writer_(participant_.writer(TopicKind::kPoses, scene.topics.poses)),
        sample_(make_batch(room)) {
    batch_.source = SourceName(source);
  }

  [[nodiscard]] dds_entity_t writer() const { return writer_; }
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

// The numbers of the next `count` batches.
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
  Scene scene = two_movers();
  DdsOptions dds = test::own_dds();
  Participant participant{dds};
  PoseReader poses{scene, participant};

  void wait_for(const Sender& sender) {
    ASSERT_TRUE(test::eventually([&] { return test::matched_readers(sender.writer()) == 1; }));
  }
};

TEST(PoseReader, HandsEveryBatchOverInOrder) {
  Port port;
  Sender sender(port.scene, port.dds, "arm");
  port.wait_for(sender);
  std::vector<std::uint64_t> sent, came;
  for (std::uint64_t round = 0; round < 20; ++round) {
    for (std::uint64_t i = 1; i <= 8; ++i) {
      sent.push_back(8 * round + i);
      sender.send(sent.back());
    }
    for (const std::uint64_t number : take(port.poses, 8)) came.push_back(number);
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
  Sender sender(port.scene, port.dds, "arm");
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
  Sender sender(port.scene, port.dds, "arm");
  port.wait_for(sender);
  for (const std::uint64_t number : {5, 6, 9, 1, 2}) sender.send(number);
  EXPECT_EQ(take(port.poses, 5), (std::vector<std::uint64_t>{5, 6, 9, 1, 2}));
  EXPECT_EQ(port.poses.tallies().at(0).lost, 2u);
}

TEST(PoseReader, CutsABatchThatIsTooLargeForTheCell) {
  Port port;
  Sender sender(port.scene, port.dds, "arm");
  port.wait_for(sender);
  const std::size_t room = PoseReader::samples_a_batch(port.scene);
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
        std::make_unique<Sender>(port.scene, port.dds, "source" + std::to_string(i), 4));
    port.wait_for(*senders.back());
    senders.back()->send(100 + i, 3);
    if (i == kMaxSources) break;
    EXPECT_EQ(take(port.poses, 1), std::vector<std::uint64_t>{100 + i});
  }
  EXPECT_TRUE(test::eventually([&] { return !port.poses.refused_sources().empty(); }));
  const auto health = make_health(port.scene, no_statistics(port.scene), port.poses, 0);
  ASSERT_EQ(health->rejected._length, 1u);
  EXPECT_STREQ(health->rejected._buffer[0].object, "source 'source16'");
  EXPECT_STREQ(health->rejected._buffer[0].cause, "one source too many");
  EXPECT_EQ(health->rejected._buffer[0].count, 3u);
  EXPECT_EQ(port.poses.tallies().size(), kMaxSources);
  EXPECT_EQ(port.poses.next(), nullptr);
}

TEST(PoseReader, DropsAndCountsWhatNoTickTakes) {
  Port port;
  Sender sender(port.scene, port.dds, "arm");
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

TEST(PoseReader, HearsNothingFromAnotherPartition) {
  Port port;
  DdsOptions elsewhere = port.dds;
  elsewhere.partition += "-elsewhere";
  Sender stranger(port.scene, elsewhere, "stranger");
  Sender sender(port.scene, port.dds, "arm");
  port.wait_for(sender);
  stranger.send(1);
  sender.send(2);
  EXPECT_EQ(take(port.poses, 1), std::vector<std::uint64_t>{2});
  EXPECT_EQ(test::matched_readers(stranger.writer()), 0u);
  EXPECT_EQ(port.poses.tallies().size(), 1u);
}

}  // namespace
}  // namespace clearance
