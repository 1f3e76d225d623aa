// A run whose cell changes is recorded and replayed to the bit.
//
// Oracles: the loop and the successors that made the run; the recording with one figure altered.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <sstream>

#include "monitor/recording/recorded_cell.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "monitor/replay/report_csv.hpp"
#include "monitor/replay/report_recorder.hpp"
#include "monitor/wire/convert.hpp"
#include "tests/monitor/replay/changing_run.hpp"

namespace clearance::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

TEST_F(ChangingRun, ReplaysBitForBitThroughEveryChange) {
  record();
  EXPECT_EQ(unknown.back(), 0u);
  const OfflineReplay replay = replay_offline(cells.front(), run, {.compare = Comparison::kBits});
  EXPECT_TRUE(replay.ok()) << replay.text();
  EXPECT_EQ(replay.compared, static_cast<std::uint64_t>(kTicks));
  for (std::size_t i = 0; i < changes.size(); ++i) {
    EXPECT_THAT(replay.notes,
                Contains(HasSubstr("is in force from tick " + std::to_string(changes[i].from))));
  }
}

TEST_F(ChangingRun, ReplaysWithoutTheFilesOfItsCells) {
  record();
  std::filesystem::remove(folder / "scara.urdf");
  std::filesystem::remove(folder / "cell.yaml");
  const auto first = recorded_cell(run, outline(run));
  ASSERT_TRUE(first);
  const OfflineReplay replay =
      replay_offline(std::get<Cell>(*first), run, {.compare = Comparison::kBits});
  EXPECT_TRUE(replay.ok()) << replay.text();
  EXPECT_EQ(replay.compared, static_cast<std::uint64_t>(kTicks));
}

TEST_F(ChangingRun, TellsHowManyChangesAnotherCellDoesNotFollow) {
  record();
  Cell other = cells.front();
  other.scene.revision = 99;
  const OfflineReplay replay = replay_offline(other, run);
  EXPECT_TRUE(replay.ok()) << replay.text();
  EXPECT_THAT(replay.notes, Contains(HasSubstr("3 changes of the recorded cell")));
}

// The same path had another content in each cell, and each one is kept.
TEST_F(ChangingRun, KeepsTheCellOfEveryChange) {
  record();
  const auto described = described_scenes({run});
  ASSERT_EQ(described.size(), cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    EXPECT_EQ(described[i].revision, cells[i].scene.revision);
    EXPECT_EQ(described[i].since, i == 0 ? SceneInForce() : changes[i - 1]);
    const CellResult read = cell_of(described[i]);
    ASSERT_TRUE(std::holds_alternative<Cell>(read));
    EXPECT_EQ(std::get<Cell>(read).scene.revision, cells[i].scene.revision);
  }
  std::vector<std::uint64_t> catalogues;
  for (const Kept& message : messages_of(run)) {
    if (message.kind == TopicKind::kCatalogue)
      catalogues.push_back(decoded<clearance_msg_Catalogue>(message)->in_force_from);
  }
  EXPECT_THAT(catalogues,
              testing::ElementsAre(0, changes[0].from, changes[1].from, changes[2].from));
}

// The cycles of a change decide on the bits: with any other one the replay is another run.
TEST_F(ChangingRun, DiffersWhereTheRecordingStatesAnotherCycleOfAChange) {
  record();
  const std::vector<Kept> messages = messages_of(run);
  const auto replayed_from = [&](std::uint64_t later) {
    const std::filesystem::path file = folder / "altered.mcap";
    std::size_t change = 0;
    {
      RecordingWriter writer(file, Topics{});
      for (const Kept& message : messages) {
        if (message.kind == TopicKind::kCatalogue) {
          const Cell& cell = cells[change];
          SceneInForce since = change == 0 ? SceneInForce() : changes[change - 1];
          if (change == 2) since.from += later;
          EXPECT_EQ("", writer.attach(cell));
          writer.catalogue(*make_catalogue(cell, since), message.log_ns);
          ++change;
          continue;
        }
        writer.write(message.kind, message.log_ns, message.publish_ns,
                     std::span<const std::byte>(message.cdr));
      }
      EXPECT_TRUE(writer.close());
    }
    return replay_offline(cells.front(), file, {.compare = Comparison::kBits});
  };
  EXPECT_TRUE(replayed_from(0).ok()) << replayed_from(0).text();
  const OfflineReplay late = replayed_from(1);
  ASSERT_FALSE(late.ok());
  EXPECT_EQ(late.failures.front().tick.recorded, changes[1].from);
}

TEST_F(ChangingRun, ReplaysUpToTheCutWhereItIsTruncated) {
  record({.compress = false});
  const std::string whole = read_text(run);
  const auto described = described_scenes({run});
  // Within the description of the second change, and in the middle of a chunk after it.
  for (const std::uint64_t size :
       {described[2].place + 40, (described[2].place + described[3].place) / 2}) {
    write_text(run, whole.substr(0, size));
    const OfflineReplay replay = replay_offline(cells.front(), run, {.compare = Comparison::kBits});
    EXPECT_TRUE(replay.ok()) << replay.text();
    EXPECT_THAT(replay.damage, HasSubstr("cut off"));
    EXPECT_GE(replay.compared, changes[1].from - 1);
    EXPECT_LT(replay.compared, static_cast<std::uint64_t>(kTicks));
  }
}

// The periods make files begin before, in and after the two steps of a change, and with its first
// report.
TEST_F(ChangingRun, InSeveralFilesReplaysAsOneAndEachFileByItself) {
  for (const int ticks : {7, 30, 53, 57, 58, 107}) {
    SCOPED_TRACE(ticks);
    record({.roll_ns = ticks * kTick});
    const std::vector<std::filesystem::path> files = later_files();
    ASSERT_GE(files.size(), 2u);
    const OfflineReplay whole =
        replay_offline(cells.front(), run, {.compare = Comparison::kBits, .continued_in = files});
    EXPECT_TRUE(whole.ok()) << whole.text();
    EXPECT_EQ(whole.compared, static_cast<std::uint64_t>(kTicks));
    for (const std::filesystem::path& file : files) {
      const std::vector<Kept> messages = messages_of(file);
      const auto first = recorded_cell(file, outline(file));
      ASSERT_TRUE(first);
      const OfflineReplay alone =
          replay_offline(std::get<Cell>(*first), file, {.compare = Comparison::kBounds});
      EXPECT_TRUE(alone.ok()) << file << alone.text();
      EXPECT_EQ(alone.ticks, static_cast<std::uint64_t>(
                                 std::ranges::count(messages, TopicKind::kDistances, &Kept::kind)));
      // The ticks after a batch of a scene that never was are not compared.
      EXPECT_GE(alone.compared, alone.ticks - alone.ticks / 5 - 1) << file << alone.text();
    }
    std::filesystem::remove(run);
    for (const std::filesystem::path& file : files) std::filesystem::remove(file);
  }
}

// Every tick of such a file has the scene that the daemon ticked.
TEST_F(ChangingRun, AFileThatBeginsInALaterSceneIsReplayedWithThatScene) {
  for (const int ticks : {19, 27, 28, 29, 53, 55, 56, 57, 58}) {
    SCOPED_TRACE(ticks);
    record({.compress = false, .roll_ns = ticks * kTick});
    const std::vector<std::filesystem::path> files = later_files();
    for (const std::filesystem::path& file : files) {
      std::vector<std::uint64_t> recorded, replayed;
      for (const Kept& message : messages_of(file)) {
        if (message.kind == TopicKind::kDistances)
          recorded.push_back(decoded<clearance_msg_Distances>(message)->scene_revision);
      }
      const auto first = recorded_cell(file, outline(file));
      ASSERT_TRUE(first);
      const OfflineReplay alone = replay_offline(
          std::get<Cell>(*first), file, {},
          [&](const ReplayedTick& tick) { replayed.push_back(tick.report.scene_revision); });
      EXPECT_EQ(recorded, replayed) << file << alone.text();
    }
    std::filesystem::remove(run);
    for (const std::filesystem::path& file : files) std::filesystem::remove(file);
  }
}

TEST_F(ChangingRun, IsRecordedAgainByItsReplayWithTheSameChanges) {
  record();
  ReportRecorder out(folder / "again.mcap", cells.front());
  const OfflineReplay replay =
      replay_offline(cells.front(), run, {}, [&out](const ReplayedTick& tick) { out.add(tick); });
  ASSERT_TRUE(replay.ok() && out.close()) << replay.text();
  const auto described = described_scenes({folder / "again.mcap"});
  ASSERT_EQ(described.size(), cells.size());
  for (std::size_t i = 1; i < cells.size(); ++i) EXPECT_EQ(described[i].since, changes[i - 1]);
}

TEST_F(ChangingRun, AsATableHasTheNamesAndTheRevisionOfTheCellThatWasInForce) {
  record();
  ReportCsv csv(folder / "t.csv", cells.front().scene, true);
  ASSERT_TRUE(replay_offline(cells.front(), run, {}, [&csv](const ReplayedTick& tick) {
                csv.add(tick);
              }).ok());
  ASSERT_TRUE(csv.close());
  const std::string text = read_text(folder / "t.csv");
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  std::size_t of_bin = 0;
  while (std::getline(lines, line)) {
    const std::uint64_t tick = std::stoull(line);
    std::size_t in_force = 0;
    while (in_force < changes.size() && tick >= changes[in_force].from) ++in_force;
    EXPECT_TRUE(line.ends_with(fmt::format(",{:016x},,,,,", cells[in_force].scene.revision)));
    const bool is_of_bin = line.find(",bin") != std::string::npos;
    EXPECT_TRUE(!is_of_bin || in_force == 2) << line;
    of_bin += is_of_bin;
  }
  EXPECT_EQ(of_bin, changes[2].from - changes[1].from);
}

TEST_F(ChangingRun, IsServedByNameInACellOfItsOwnThatDoesNotChange) {
  record();
  const Cell other = read_good(
      "name: other\nunits: {length: m, angle: rad}\nrobots: [{name: arm, urdf: scara.urdf}]\n"
      "objects: [{name: cart, may_jump: true, sphere: {radius: 0.2}}]\n"
      "pairs: [{between: [arm, cart], publish: true}]\n",
      folder / "other.yaml");
  std::vector<std::uint64_t> revisions;
  std::uint32_t unknown_at_end = 99;
  const OfflineReplay replay = replay_offline(other, run, {}, [&](const ReplayedTick& tick) {
    revisions.push_back(tick.report.scene_revision);
    unknown_at_end = tick.report.unknown;
  });
  EXPECT_TRUE(replay.ok()) << replay.text();
  EXPECT_EQ(revisions, std::vector<std::uint64_t>(kTicks, other.scene.revision));
  EXPECT_EQ(unknown_at_end, 0u) << "batches of every revision have names";
}

TEST_F(ChangingRun, AnExpectationOfAZoneHoldsInEveryCellThatHasIt) {
  record();
  const OfflineReplay near = replay_offline(cells.front(), run, {.expect_no_zone = {"near"}});
  EXPECT_FALSE(near.ok());
  const OfflineReplay over = replay_offline(cells.front(), run, {.expect_no_zone = {"over"}});
  EXPECT_THAT(over.error, HasSubstr("no zone 'over'"));
}

}  // namespace
}  // namespace clearance::test
