// The states of a partner in a recording: which of those that came are there, and where.
#include "monitor/daemon/recording.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "monitor/files/build_info.hpp"
#include "monitor/files/reader.hpp"
#include "monitor/recording/topic_schema.hpp"
#include "monitor/recording/writer.hpp"
#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/shared/loopback.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {
namespace {

class RecordedStates : public testing::Test {
 protected:
  RecordedStates() { sinks.push_back(&recording.sink()); }
  static std::vector<std::byte> bytes_of(std::uint64_t lineage) {
    return std::vector<std::byte>(100 + lineage, static_cast<std::byte>(lineage));
  }
  void note(std::uint64_t lineage) {
    const std::vector<std::byte> bytes = bytes_of(lineage);
    recording.note_state(
        {.revision = cell->scene.revision, .lineage = lineage, .cycle = 5, .bytes = bytes});
  }
  // `joined`: the tick goes on from the state of this lineage; 0: from the tick before.
  void tick(std::uint64_t joined = 0) {
    now_ns += kTick;
    if (joined != 0) sinks.back()->joined(joined);
    sinks.back()->report(monitor.tick({}, now_ns), {});
  }
  // The messages of the file in their order: c is a catalogue, d a report, s7 the state of lineage
  // 7 as it was noted, x any other state, and #1 the number of the state that follows, or is lost.
  std::string recorded() {
    recording.finish();
    EXPECT_TRUE(recording.complete());
    McapReader reader(folder / "a.mcap");
    McapMessage message;
    std::string order, number;
    while (reader.next(message)) {
      const std::string& type = message.channel->schema.name;
      const bool is_report = type.ends_with("::Distances");
      const bool is_state = type == side_schema(SideTopic::kStates).name;
      const auto of_state = reader.metadata().find(std::string(kJoinedMetadata));
      if (of_state != reader.metadata().end() && of_state->second.at("number") != number) {
        number = of_state->second.at("number");
        order += '#' + number;
      }
      if (type.ends_with("::Catalogue")) order += 'c';
      if (is_report) order += 'd';
      if (is_state) order += text_of(message.payload);
    }
    EXPECT_EQ(reader.error(), "");
    return order;
  }
  std::string text_of(std::span<const std::byte> cdr) {
    Sample<clearance_msg_PartnerState> message;
    if (!CdrDecoder().decode(cdr, message)) return "x";
    const auto state = from_wire(*message, kBuild);
    const bool is_as_noted = state && state->revision == cell->scene.revision &&
                             state->cycle == 5 &&
                             std::ranges::equal(state->bytes, bytes_of(state->lineage));
    return is_as_noted ? 's' + std::to_string(state->lineage) : "x";
  }

  const ScratchFolder folder;
  const std::shared_ptr<const Cell> cell = std::make_shared<const Cell>(Cell{bench_cell()});
  Participant participant{own_dds()};
  PoseReader poses{*cell, participant};
  RecordingHealth health;
  Recording recording{folder / "a.mcap", {.overwrite = false}, cell, poses, health};
  std::vector<ReportSink*> sinks;  // of the cells, the last one is in force
  Monitor monitor{cell->scene};
  std::int64_t now_ns = kStart;
};

TEST_F(RecordedStates, StandInFrontOfTheFirstReportThatGoesOnFromThem) {
  tick();
  note(7);
  tick();
  tick(7);
  tick();
  note(8);
  tick(8);
  EXPECT_EQ(recorded(), "cdd#1s7dd#2s8d");
}

TEST_F(RecordedStates, AreNotThereIfTheLoopHasNotTakenThemOver) {
  note(7);
  note(8);
  note(9);
  tick(8);
  tick();
  EXPECT_EQ(recorded(), "c#1s8dd");
}

// A replay must know that the reports go on from something that it does not have. A state that came
// before one that was taken over is forgotten with it.
TEST_F(RecordedStates, ThatAreLostAreNumberedAllTheSame) {
  tick(6);
  note(7);
  note(8);
  tick(8);
  tick(7);
  note(9);
  tick(9);
  EXPECT_EQ(recorded(), "c#1d#2s8d#3d#4s9d");
}

TEST_F(RecordedStates, WaitUpToEightOfThemAndThenTheOldestGoes) {
  for (std::uint64_t lineage = 1; lineage <= 9; ++lineage) note(lineage);
  tick(1);
  tick(2);
  tick(9);
  EXPECT_EQ(recorded(), "c#1d#2s2d#3s9d");
}

TEST_F(RecordedStates, StandBehindTheDescriptionOfACellThatChanged) {
  tick();
  note(7);
  ReportSink* const next = recording.prepare(std::make_shared<const Cell>(*cell));
  ASSERT_NE(next, nullptr);
  recording.follow({.began_after = 1, .from = 2});
  sinks.push_back(next);
  tick(7);
  EXPECT_EQ(recorded(), "cdc#1s7d");
}

}  // namespace
}  // namespace clearance::test
