// clearance-record and clearance-replay as a person runs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <span>

#include "monitor/files/pose_log.hpp"
#include "monitor/wire/cdr.hpp"
#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/bench_cell.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// The hand descends to 80 mm above the box.
std::string descending_log() {
  std::string log = "t_ns,object,px,py,pz,qw,qx,qy,qz\n";
  for (int tick = 0; tick < 200; ++tick) {
    const std::string time = std::to_string(tick * kTick);
    const double z = hand_at(tick, 200, 0.08).position.z();
    log += time + ",hand,0,0," + std::to_string(z) + ",1,0,0,0\n";
    log += time + ",tool,0,2,0,1,0,0,0\n";
  }
  return log;
}

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Without what states where the message was written.
template <class Message>
std::string unsealed(const Kept& message) {
  CdrDecoder decoder;
  CdrEncoder encoder;
  Sample<Message> sample;
  EXPECT_TRUE(decoder.decode(message.cdr, sample));
  sample->address = sample->delivery_checksum = 0;
  return text_of(encoder.encode(*sample));
}

// Reports and catalogues are sealed anew for the place where they are published.
std::string text_of(const Kept& message) {
  if (message.kind == TopicKind::kDistances) return unsealed<clearance_msg_Distances>(message);
  if (message.kind == TopicKind::kCatalogue) return unsealed<clearance_msg_Catalogue>(message);
  return text_of(std::span<const std::byte>(message.cdr));
}

class RecordReplay : public RunsPrograms {
 protected:
  RecordReplay() {
    write_text(folder / "cell.yaml", kBenchCell);
    write_text(folder / "log.csv", descending_log());
  }
  // Runs a program as run() does, with a signal that is pending before the program begins.
  int run_stopped(int signal, const std::string& program,
                  const std::vector<std::string>& arguments) {
    sigset_t both, before;
    sigemptyset(&both);
    sigaddset(&both, SIGINT);
    sigaddset(&both, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &both, &before);
    ChildProcess child(program, arguments);
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    child.signal(signal);
    const int status = child.wait();
    output = child.output();
    return status;
  }
  int record_log() {
    return run(kRecord, {"--from-csv", path("log.csv"), "-o", path("run.mcap"), "--cell",
                         path("cell.yaml")});
  }
  int replay(const std::vector<std::string>& more) {
    return run(kReplay, with({"check", "--cell", path("cell.yaml"), path("run.mcap")}, more));
  }
  // Publishes run.mcap over DDS slowly, and records it in again.mcap.
  void publish_and_record_again(std::string& recorder_output) {
    const auto where = dds_arguments(own_dds());
    ChildProcess recorder(kRecord, with({"-o", path("again.mcap")}, where));
    ASSERT_EQ(0, run(kReplay,
                     with({"publish", path("run.mcap"), "--wait", "20", "--rate", "0.25"}, where)))
        << output;
    recorder.signal(SIGINT);
    const int status = recorder.wait();
    recorder_output = recorder.output();
    ASSERT_EQ(0, status) << recorder_output;
  }
};

TEST_F(RecordReplay, PoseLogBecomesARecordingThatReplaysIntoATable) {
  ASSERT_EQ(0, record_log()) << output;
  EXPECT_THAT(output, HasSubstr("400 rows, 2 objects, 200 samples"));
  ASSERT_EQ(0, replay({"--csv", path("t.csv")})) << output;
  EXPECT_THAT(output, HasSubstr("200 ticks"));
  EXPECT_THAT(output, HasSubstr("closest: hand - box, 0.08 m"));
  EXPECT_EQ(1 + 2 * 200, std::ranges::count(read_text(folder / "t.csv"), '\n'));
}

TEST_F(RecordReplay, TableHasEveryPairUnlessOnlyThePublishedAreAskedFor) {
  std::string cell = kBenchCell;
  const std::string rule = "  - {between: [robot, still], publish: true}\n";
  cell.insert(cell.find(rule), "  - {between: [hand, tool], publish: false}\n");
  write_text(folder / "cell.yaml", cell.insert(cell.find("objects:"), "budget: 1\n"));
  ASSERT_EQ(0, record_log()) << output;
  ASSERT_EQ(0, replay({"--csv", path("all.csv")})) << output;
  const std::string all = read_text(folder / "all.csv");
  EXPECT_EQ(1 + 3 * 200, std::ranges::count(all, '\n'));
  EXPECT_THAT(all, HasSubstr(",hand,tool,"));
  EXPECT_THAT(all, HasSubstr(",carried,"));
  ASSERT_EQ(0, replay({"--csv", path("all.csv"), "--evaluate-all", "--force"})) << output;
  EXPECT_THAT(read_text(folder / "all.csv"), testing::Not(HasSubstr(",carried,")));
  ASSERT_EQ(0, replay({"--csv", path("some.csv"), "--published"})) << output;
  EXPECT_EQ(1 + 2 * 200, std::ranges::count(read_text(folder / "some.csv"), '\n'));
  EXPECT_EQ(2, replay({"--published"}));
  EXPECT_EQ(2, replay({"--compare", "--evaluate-all"}));
}

TEST_F(RecordReplay, AResultIsWrittenForCiSystems) {
  ASSERT_EQ(0, record_log()) << output;
  EXPECT_EQ(0,
            replay({"--expect-min-distance", "0.01", "--end", "0.149", "--junit", path("met.xml")}))
      << output;
  EXPECT_THAT(output, HasSubstr("150 ticks, 0.149 s recorded"));
  const std::string met = read_text(folder / "met.xml");
  EXPECT_THAT(met, HasSubstr("tests=\"2\" failures=\"0\" errors=\"0\""));
  EXPECT_THAT(met, HasSubstr("<property name=\"ticks\" value=\"150\"/>"));
  EXPECT_THAT(met, HasSubstr("<property name=\"not_judged\" value=\""));
  EXPECT_THAT(met, HasSubstr("run.mcap: at least 0.01 m\">\n      <system-out>least: tick 101, "
                             "0.100 s: hand - box is 0.08 m apart"));
  EXPECT_EQ(1, replay({"--expect-min-distance", "0.2", "--between", "tool,box=0.01", "--between",
                       "hand,box", "--junit", path("failed.xml")}));
  const std::string failed = read_text(folder / "failed.xml");
  EXPECT_THAT(failed, HasSubstr("tests=\"3\" failures=\"1\" errors=\"0\""));
  EXPECT_THAT(failed, HasSubstr("<failure message=\"tick "));
  EXPECT_EQ(1, replay({"--junit", path("met.xml")})) << "it exists";
  EXPECT_EQ(2, replay({"--junit", path("t.csv"), "--csv", path("t.csv")}));
}

TEST_F(RecordReplay, ReferenceDistancesAreMetOrNamedWithTickPairAndFigure) {
  ASSERT_EQ(0, record_log()) << output;
  std::string reference = "distance,object_b,object_a,t_ns\n";
  for (int tick = 0; tick < 200; tick += 10) {
    const double above = hand_at(tick, 200, 0.08).position.z() - 0.15;
    reference += std::to_string(above) + ",box,hand," + std::to_string(tick * kTick) + "\n";
  }
  write_text(folder / "ref.csv", reference);
  EXPECT_EQ(0, replay({"--reference", path("ref.csv")})) << output;
  EXPECT_THAT(output, HasSubstr("20 reference distances compared, largest difference "));
  EXPECT_THAT(output, HasSubstr("0 off by more than 1e-06 m, 0 outside of the bounds"));
  reference.replace(reference.find("0.080000"), 8, "0.080100");
  write_text(folder / "ref.csv", reference);
  EXPECT_EQ(1, replay({"--reference", path("ref.csv"), "--tolerance", "5e-5"}));
  EXPECT_THAT(output, HasSubstr("tick 101 (0.100000 s): hand - box: converged, distance 0.08 m, "
                                "reference 0.0801 m: not within the tolerance of 5e-05 m"));
  EXPECT_THAT(output, HasSubstr("bounds 0.08 m to 0.08 m, reference 0.0801 m: outside"));
}

TEST_F(RecordReplay, BrokenExpectationGivesStatusOneAndNamesTickPairAndFigure) {
  ASSERT_EQ(0, record_log()) << output;
  EXPECT_EQ(0, replay({"--expect-min-distance", "0.0799"})) << output;
  EXPECT_EQ(1, replay({"--expect-min-distance", "0.09"}));
  EXPECT_THAT(output, testing::ContainsRegex("tick 9[0-9] .*: hand - box is 0\\.08[0-9]* m apart"));
  EXPECT_EQ(1, replay({"--expect-no-zone", "stop"}));
  EXPECT_THAT(output,
              testing::ContainsRegex("tick [0-9]+ .*: zone 'stop' is active: hand - box has"));
  EXPECT_EQ(1, replay({"--expect-no-zone", "halt"}));
  EXPECT_THAT(output, HasSubstr("the cell has no zone 'halt'"));
}

TEST_F(RecordReplay, ReplayOfAReplayIsTheSameToTheByteAndComparesAsSuch) {
  ASSERT_EQ(0, record_log()) << output;
  ASSERT_EQ(0, replay({"-o", path("a.mcap")})) << output;
  ASSERT_EQ(0, replay({"-o", path("b.mcap")})) << output;
  EXPECT_EQ(read_text(folder / "a.mcap"), read_text(folder / "b.mcap"));
}

TEST_F(RecordReplay, RecordingOfAMonitorComparesEqualAndAnAlteredOneNamesTheField) {
  const Cell cell = std::get<Cell>(read_cell(folder / "cell.yaml"));
  record_run(cell, folder / "run.mcap", {.ticks = 100});
  EXPECT_EQ(0, replay({"--compare"})) << output;
  EXPECT_THAT(output, HasSubstr("100 reports compared"));
  // The recording also contains the cell.
  EXPECT_EQ(0, run(kReplay, {"check", path("run.mcap"), "--compare"})) << output;
  std::vector<Kept> messages = messages_of(folder / "run.mcap");
  Kept& last =
      *std::ranges::find(messages.rbegin(), messages.rend(), TopicKind::kDistances, &Kept::kind);
  last = altered<clearance_msg_Distances>(
      last, [](clearance_msg_Distances& report) { ++report.queries; });
  write_messages(folder / "run.mcap", messages);
  EXPECT_EQ(1, replay({"--compare"}));
  EXPECT_THAT(
      output,
      HasSubstr("tick 100 (0.099000 s): the replay differs in queries: recorded 3, replayed 2"));
}

TEST_F(RecordReplay, DamagedRecordingGivesStatusFiveAndSaysHowMuchWasRead) {
  ASSERT_EQ(0, record_log()) << output;
  const std::string whole = read_text(folder / "run.mcap");
  write_text(folder / "run.mcap", whole.substr(0, whole.size() / 2));
  EXPECT_EQ(5, replay({}));
  EXPECT_THAT(output, HasSubstr("is damaged at byte"));
  EXPECT_THAT(output, HasSubstr("Before that came "));
  EXPECT_EQ(1, replay({"--expect-min-distance", "1"}));
}

TEST_F(RecordReplay, MistakesAreToldWithTheRightStatus) {
  EXPECT_EQ(1, run(kReplay, {"check", path("none.mcap"), "--cell", path("cell.yaml")}));
  EXPECT_THAT(output, HasSubstr("cannot read " + path("none.mcap") + ": No such file"));
  EXPECT_EQ(1, run(kReplay, {"check", path(""), "--cell", path("cell.yaml")}));
  EXPECT_THAT(output, HasSubstr("is no bag: it has neither metadata.yaml nor .mcap"));
  EXPECT_EQ(1, run(kRecord, {"--from-csv", path("none.csv"), "-o", path("never.mcap")}));
  EXPECT_THAT(output, HasSubstr("cannot read " + path("none.csv") + ": No such file"));
  EXPECT_EQ(2, run(kReplay, {"publish", path("run.mcap"), "--compare"}));
  ASSERT_EQ(0, record_log());
  EXPECT_EQ(1, record_log());
  EXPECT_THAT(output, HasSubstr("run.mcap exists; --force overwrites it"));
  EXPECT_EQ(1, replay({"--csv", path("nowhere/table.csv"), "-o", path("again.mcap")}));
  EXPECT_THAT(output, HasSubstr("cannot create " + path("nowhere/table.csv")));
  EXPECT_EQ(1, replay({"-o", path("nowhere/again.mcap")}));
  EXPECT_THAT(output, HasSubstr("there is no folder " + path("nowhere")));
  EXPECT_THAT(output, testing::Not(HasSubstr("ticks"))) << "replayed in vain";
  EXPECT_FALSE(std::filesystem::exists(folder / "again.mcap")) << "replayed in vain";
  write_text(folder / "cell.yaml", "nmae: x\n");
  EXPECT_EQ(3, replay({}));
  EXPECT_THAT(output, HasSubstr("cell.yaml:1:1"));
}

TEST_F(RecordReplay, RecorderSaysThatItsFileWasDeleted) {
  ChildProcess recorder(kRecord, with({"-o", path("run.mcap")}, dds_arguments(own_dds())));
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(folder / "run.mcap"); }));
  std::filesystem::remove(folder / "run.mcap");
  EXPECT_EQ(1, recorder.wait());
  EXPECT_TRUE(recorder.wrote("run.mcap was deleted while it was being written"))
      << recorder.output();
}

TEST_F(RecordReplay, NeverWritesOverAFileThatItReads) {
  ASSERT_EQ(0, record_log()) << output;
  write_text(folder / "reference.csv", "precious");
  for (const char* read : {"run.mcap", "cell.yaml", "reference.csv"}) {
    const std::string before = read_text(folder / read);
    for (const char* option : {"-o", "--csv"}) {
      EXPECT_EQ(2, replay({option, path(read), "--reference", path("reference.csv"), "--force"}));
      EXPECT_THAT(output, HasSubstr("is a file that is read; expected another one to write"));
      EXPECT_EQ(before, read_text(folder / read));
    }
  }
  const std::string log = read_text(folder / "log.csv");
  EXPECT_EQ(2, run(kRecord, {"--from-csv", path("log.csv"), "-o", path("log.csv"), "--force"}));
  EXPECT_EQ(log, read_text(folder / "log.csv"));
}

TEST_F(RecordReplay, WhatASignalStopsEndsInOrderAndLeavesNothingHalf) {
  const std::vector<std::string> from_csv = {"--from-csv", path("log.csv"), "-o", path("no.mcap")};
  ASSERT_EQ(0, record_log()) << output;
  for (const int signal : {SIGINT, SIGTERM}) {
    EXPECT_EQ(1, run_stopped(signal, kRecord, from_csv));
    EXPECT_THAT(output, HasSubstr("stopped after 0 rows of " + path("log.csv") + " were checked"));
    EXPECT_FALSE(std::filesystem::exists(folder / "no.mcap"));
    write_text(folder / "old.mcap", "precious");
    EXPECT_EQ(5, run_stopped(signal, kReplay,
                             {"check", "--cell", path("cell.yaml"), path("run.mcap"), "--force",
                              "-o", path("old.mcap"), "--csv", path("t.csv")}));
    EXPECT_THAT(output, HasSubstr("stopped after 0 ticks"));
    EXPECT_THAT(output, HasSubstr(path("t.csv") + " was not finished and is removed"));
    EXPECT_FALSE(std::filesystem::exists(folder / "t.csv"));
    EXPECT_EQ("precious", read_text(folder / "old.mcap"));
  }
}

TEST_F(RecordReplay, TwoOutputsAreTwoFiles) {
  ASSERT_EQ(0, record_log()) << output;
  EXPECT_EQ(2, replay({"-o", path("both"), "--csv", path("./both")}));
  EXPECT_THAT(output, HasSubstr("name the same file"));
  EXPECT_FALSE(std::filesystem::exists(folder / "both"));
}

TEST_F(RecordReplay, ANumberThatIsNoneIsWrongUsage) {
  ASSERT_EQ(0, record_log()) << output;
  EXPECT_EQ(2, replay({"--expect-min-distance", "nan"}));
  EXPECT_THAT(output, HasSubstr("found 'nan'; expected a finite number"));
  EXPECT_EQ(2, replay({"--start", "-1"}));
  EXPECT_THAT(output, HasSubstr("found '-1'; expected a number, 0 or more"));
  EXPECT_EQ(2, run(kReplay, {"publish", path("run.mcap"), "--rate", "inf"}));
  EXPECT_THAT(output, HasSubstr("found 'inf'; expected a number above 0"));
  EXPECT_EQ(2, replay({"--allow-unknown", "nan"}));
  EXPECT_THAT(output, HasSubstr("found 'nan'; expected a number from 0 to 1"));
}

TEST_F(RecordReplay, WritesOverOtherFilesOnlyWhenForced) {
  ASSERT_EQ(0, record_log()) << output;
  for (const char* option : {"-o", "--csv"}) {
    write_text(folder / "old", "precious");
    EXPECT_EQ(1, replay({option, path("old")}));
    EXPECT_THAT(output, HasSubstr("old exists; --force overwrites it"));
    EXPECT_EQ("precious", read_text(folder / "old"));
    EXPECT_EQ(0, replay({option, path("old"), "--force"})) << output;
    EXPECT_NE("precious", read_text(folder / "old"));
  }
}

TEST_F(RecordReplay, WhatIsPublishedOverDdsAndRecordedAgainIsTheSameBytes) {
  const Cell cell = std::get<Cell>(read_cell(folder / "cell.yaml"));
  record_run(cell, folder / "run.mcap", {.ticks = 300, .nearest = 0.05});
  std::string recorder_output;
  ASSERT_NO_FATAL_FAILURE(publish_and_record_again(recorder_output));
  const std::vector<Kept> sent = messages_of(folder / "run.mcap");
  const std::vector<Kept> received = messages_of(folder / "again.mcap");
  for (const TopicKind kind : {TopicKind::kCatalogue, TopicKind::kPoses, TopicKind::kDistances}) {
    std::vector<std::string> a, b;
    for (const Kept& message : sent) {
      if (message.kind == kind) a.push_back(text_of(message));
    }
    for (const Kept& message : received) {
      if (message.kind == kind) b.push_back(text_of(message));
    }
    // Samples of two sources with the same stamp may be swapped.
    std::ranges::sort(a);
    std::ranges::sort(b);
    EXPECT_EQ(a.size(), b.size());
    EXPECT_TRUE(a == b);
  }
  // The recording still replays to the same reports, although topics overtook each other.
  EXPECT_EQ(0, run(kReplay, {"check", path("again.mcap"), "--compare"})) << output;
}

TEST_F(RecordReplay, RecorderTellsWhatItMissed) {
  const Cell cell = std::get<Cell>(read_cell(folder / "cell.yaml"));
  record_run(cell, folder / "run.mcap", {.ticks = 40});
  std::vector<Kept> messages = messages_of(folder / "run.mcap");
  const auto is_lost = [](const Kept& message) {
    if (message.kind == TopicKind::kDistances) {
      return decoded<clearance_msg_Distances>(message)->cycle == 7;
    }
    if (message.kind != TopicKind::kPoses) return false;
    const auto batch = decoded<clearance_msg_PoseBatch>(message);
    const bool arm = std::string_view(batch->source) == "arm";
    return arm ? batch->sequence_number == 3 || batch->sequence_number == 5
               : batch->sequence_number == 1;
  };
  std::erase_if(messages, is_lost);
  write_messages(folder / "run.mcap", messages);
  std::string recorder;
  ASSERT_NO_FATAL_FAILURE(publish_and_record_again(recorder));
  EXPECT_THAT(recorder, HasSubstr("missing in between: 2 of the batches of source 'arm'"));
  EXPECT_THAT(recorder, HasSubstr("the first of the batches of source 'cell' here is number 2"));
  EXPECT_THAT(recorder, HasSubstr("missing in between: 1 of the reports of the daemon"));
}

TEST_F(RecordReplay, AWindowWithoutAnythingIsAnError) {
  ASSERT_EQ(0, record_log()) << output;
  EXPECT_EQ(2, replay({"--start", "0.1", "--end", "0.05"}));
  EXPECT_THAT(output, HasSubstr("--start 0.1 lies after --end 0.05"));
  EXPECT_EQ(1, replay({"--start", "10"}));
  EXPECT_THAT(output, HasSubstr("no tick lies between the start and the end given"));
  EXPECT_EQ(1, run(kReplay, with({"publish", path("run.mcap"), "--start", "10", "--wait", "0"},
                                 dds_arguments(own_dds()))));
  EXPECT_THAT(output, HasSubstr("no message of these topics lies between"));
  EXPECT_THAT(output, HasSubstr("found there: none at all"));
  EXPECT_EQ(
      1, run(kReplay, with({"publish", path("run.mcap"), "--only", "clearance/pose", "--wait", "0"},
                           dds_arguments(own_dds()))));
  EXPECT_THAT(output, HasSubstr("found there: clearance/catalogue, clearance/poses"));
}

TEST_F(RecordReplay, ReportsWithoutTheirPosesCannotBeCompared) {
  const Cell cell = std::get<Cell>(read_cell(folder / "cell.yaml"));
  record_run(cell, folder / "run.mcap", {.ticks = 40});
  std::vector<Kept> messages = messages_of(folder / "run.mcap");
  std::erase_if(messages, [](const Kept& message) { return message.kind == TopicKind::kPoses; });
  write_messages(folder / "run.mcap", messages);
  EXPECT_EQ(1, replay({"--compare"}));
  EXPECT_THAT(output, HasSubstr("tick 1 (0.000000 s): poses that this tick used are not in the "
                                "recording: it cannot be compared"));
}

TEST_F(RecordReplay, PartitionsWithWildcardsAndLongSourceNamesAreRefused) {
  const auto is_refused = [this](const std::string& program, std::vector<std::string> arguments) {
    EXPECT_EQ(2,
              run(program, with(std::move(arguments), {path("cell.yaml"), "--partition", "a*"})));
    EXPECT_THAT(output, HasSubstr("found 'a*'; expected a partition of at most 255 bytes"));
  };
  is_refused(kDaemon, {});
  is_refused(kRobot, {});
  is_refused(kReplay, {"publish"});
  EXPECT_EQ(2, run(kRobot, {path("cell.yaml"), "--source", std::string(33, 'x')}));
  EXPECT_THAT(output, HasSubstr("expected a name of 1 to 32 bytes"));
}

}  // namespace
}  // namespace clearance::test
