// Compressed, thinned and rolled-over recordings still replay.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "monitor/files/numbered_file.hpp"
#include "monitor/wire/convert.hpp"
#include "tests/monitor/replay/offline_replay_run.hpp"

namespace clearance::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

class RecordingOptionsTest : public OfflineReplayTest {
 protected:
  void record(RecordingOptions options, int ticks = 400) {
    options.overwrite = true;
    record_run(cell, run, {.ticks = ticks}, options);
  }
  std::size_t count(TopicKind kind) {
    return static_cast<std::size_t>(std::ranges::count(messages_of(run), kind, &Kept::kind));
  }
};

TEST_F(RecordingOptionsTest, CompressedOnesHoldTheSameMessagesAndAreSmaller) {
  record({.compress = false});
  const auto stored = messages_of(run);
  const auto size = std::filesystem::file_size(run);
  record({});
  const auto compressed = messages_of(run);
  EXPECT_LT(2 * std::filesystem::file_size(run), size);
  ASSERT_EQ(stored.size(), compressed.size());
  for (std::size_t i = 0; i < stored.size(); ++i) {
    EXPECT_EQ(stored[i].cdr, compressed[i].cdr);
    EXPECT_EQ(stored[i].log_ns, compressed[i].log_ns);
  }
  EXPECT_TRUE(replay({.compare = Comparison::kBits}).ok());
}

TEST_F(RecordingOptionsTest, EveryTenthReportKeepsItsPairsAndAllTicksCompareToTheBit) {
  record({.pairs_every = 10});
  std::size_t with_pairs = 0;
  for (const Kept& message : messages_of(run)) {
    if (message.kind != TopicKind::kDistances) continue;
    const auto report = decoded<clearance_msg_Distances>(message);
    EXPECT_EQ(report->cycle % 10 == 0, report->pairs._length > 0);
    with_pairs += report->pairs._length > 0;
  }
  EXPECT_EQ(40u, with_pairs);
  const OfflineReplay same = replay({.compare = Comparison::kBits});
  EXPECT_TRUE(same.ok()) << same.text();
  EXPECT_EQ(400u, same.compared);
}

// A topic that was left out cannot differ.
TEST_F(RecordingOptionsTest, WithoutZonesTheReportsCompareToTheBit) {
  record({});
  ASSERT_GT(count(TopicKind::kZones), 0u);
  record({.left_out = {TopicKind::kZones}});
  ASSERT_EQ(count(TopicKind::kZones), 0u);
  const OfflineReplay same = replay({.compare = Comparison::kBits});
  EXPECT_TRUE(same.ok()) << same.text();
}

// Without pairs, a report still differs if its minimum does. A report that lost its pairs also
// differs, if the recording keeps all pairs.
TEST_F(RecordingOptionsTest, ThinnedReportsAreComparedAllTheSame) {
  record({.pairs_every = 10});
  std::vector<Kept> messages = messages_of(run);
  Kept& thin = messages[report_of(messages, 33)];
  thin = altered<clearance_msg_Distances>(
      thin, [](clearance_msg_Distances& report) { report.minimum.lower -= 1e-9; });
  RecordingWriter writer(run, cell.topics, {.pairs_every = 10});
  writer.describe(*make_catalogue(cell));
  for (const Kept& message : messages) {
    writer.write(message.kind, message.log_ns, message.publish_ns,
                 std::span<const std::byte>(message.cdr));
  }
  ASSERT_TRUE(writer.close());
  EXPECT_THAT(replay({.compare = Comparison::kBits}).text(), HasSubstr("tick 33 "));
  record({});
  rewrite([](std::vector<Kept>& all) {
    Kept& report = all[report_of(all, 33)];
    report = altered<clearance_msg_Distances>(
        report, [](clearance_msg_Distances& whole) { whole.pairs._length = 0; });
  });
  EXPECT_THAT(replay({.compare = Comparison::kBits}).text(), HasSubstr("tick 33 "));
}

TEST_F(RecordingOptionsTest, TopicsThatAreLeftOutAreNotThere) {
  record({.left_out = {TopicKind::kDistances, TopicKind::kZones}});
  EXPECT_EQ(0u, count(TopicKind::kDistances));
  EXPECT_EQ(0u, count(TopicKind::kZones));
  EXPECT_GT(count(TopicKind::kPoses), 300u);
  EXPECT_EQ(1u, count(TopicKind::kCatalogue));
  McapReader reader(run);
  ASSERT_TRUE(reader.summary());
  EXPECT_EQ(kRecordedTopics.size() - 2, reader.summary()->channels.size());
  const OfflineReplay done = replay({.tick_hz = 1000.0, .expect_min_distance = 0.01});
  EXPECT_TRUE(done.ok()) << done.text();
  EXPECT_NEAR(400.0, static_cast<double>(done.ticks), 1.0) << "from the first pose on";
}

TEST_F(RecordingOptionsTest, FilesFollowEachOtherAndReplayAsOne) {
  record({.roll_ns = 100 * kTick});
  std::vector<std::filesystem::path> files;
  for (auto file = run; is_taken(file); file = next_number(file)) files.push_back(file);
  ASSERT_EQ(4u, files.size());
  EXPECT_EQ("run-4.mcap", files.back().filename());
  const OfflineReplay whole =
      replay({.compare = Comparison::kBits, .continued_in = {files.begin() + 1, files.end()}});
  EXPECT_TRUE(whole.ok()) << whole.text();
  EXPECT_EQ(400u, whole.compared);
  // Each file can be compared alone: names, zones and bounds.
  const OfflineReplay third = replay_offline(cell, files[2], {.compare = Comparison::kBounds});
  EXPECT_TRUE(third.ok()) << third.text();
  EXPECT_GE(third.compared, 95u);
  McapReader reader(files[2]);
  EXPECT_EQ("3", reader.summary()->metadata.at(std::string(kRecordingMetadata)).at("part"));
  RecordingReader messages(files[2]);
  RecordedMessage message;
  std::set<TopicKind> kinds;
  while (messages.next(message)) kinds.insert(message.kind);
  EXPECT_THAT(kinds, Contains(TopicKind::kZones));
  EXPECT_THAT(kinds, Contains(TopicKind::kCatalogue));
}

TEST_F(RecordingOptionsTest, ANewFileBeginsWhenOneIsLarge) {
  record({.compress = false, .roll_bytes = 200'000});
  EXPECT_GE(std::filesystem::file_size(run), 200'000u);
  EXPECT_LT(std::filesystem::file_size(run), 230'000u);
  EXPECT_TRUE(is_taken(folder / "run-2.mcap"));
}

TEST_F(RecordingOptionsTest, TheNextFileReplacesNoneUnlessTheFirstMay) {
  write_text(folder / "run-2.mcap", "precious");
  const RecordingOptions rolled{.overwrite = false, .roll_ns = 100 * kTick};
  record_run(cell, run, {.ticks = 150}, rolled);
  EXPECT_EQ("precious", read_text(folder / "run-2.mcap"));
  EXPECT_TRUE(is_taken(folder / "run-3.mcap"));
  record({.roll_ns = 100 * kTick}, 150);
  EXPECT_NE("precious", read_text(folder / "run-2.mcap"));
}

TEST(NumberedFile, CountsUpWhatIsANumber) {
  EXPECT_EQ("a/run-2.mcap", next_number("a/run.mcap"));
  EXPECT_EQ("a/run-10.mcap", next_number("a/run-9.mcap"));
  EXPECT_EQ("run-2026112212-2.mcap", next_number("run-2026112212.mcap"));
  EXPECT_EQ("run-left-2.mcap", next_number("run-left.mcap"));
  EXPECT_EQ("run-1-2.mcap", next_number("run-1.mcap"));
  EXPECT_EQ("-5-2", next_number("-5"));
}

}  // namespace
}  // namespace clearance::test
