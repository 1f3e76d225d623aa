// --record: the content of the file, and the behaviour of a daemon whose disk fails.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <csignal>

#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/shared/take_next.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;

const bool kNoHangingDisk = test::places::hanging_disk().empty();

// A daemon that records, with a client for its reports and its health.
class RecordingDaemon : public testing::Test {
 protected:
  explicit RecordingDaemon(const std::string& text = small_cell("small")) : cell(text) {}

  std::string path(const std::string& name) const { return (folder / name).string(); }

  void start(const ChildOptions& options = {}) {
    // The recording is uncompressed, so that the file grows fast.
    daemon.emplace(kDaemon,
                   with({cell.path(), "--record", path("run.mcap"), "--record-uncompressed"},
                        dds_arguments(dds)),
                   options);
    distances.settle();
  }
  // Starts the daemon with a disk that hangs as long as the file 'hang' exists.
  void start_on_a_disk_that_may_hang() {
    start({.environment = {{"LD_PRELOAD", test::places::hanging_disk()},
                           {"CLEARANCE_DISK_HANGS_IF", path("hang")}}});
    ASSERT_TRUE(eventually([&] { return size("run.mcap") > 50'000; })) << daemon->output();
  }
  // Expects that reports continue without a gap.
  void expect_reports(int count) {
    std::uint64_t cycle = 0;
    for (int i = 0; i < count; ++i) {
      const auto report = distances.next();
      ASSERT_NE(report, nullptr) << daemon->output();
      if (i > 0) {
        ASSERT_EQ(cycle + 1, (*report)->cycle) << "the daemon was held up";
      }
      cycle = (*report)->cycle;
    }
  }
  // Waits until the health topic reports this state of the recording and this number of missing
  // messages.
  bool health_says(const std::string& what, std::uint64_t missing = 0) {
    Sample<clearance_msg_Health> sample;
    return eventually([&] {
      return take_next(health, sample) &&
             std::string(sample->recording).find(what) != std::string::npos &&
             sample->recording_missing >= missing;
    });
  }
  // The consequences that every fault of the file must have.
  void expect_told(const std::string& what) {
    EXPECT_TRUE(health_says(what)) << daemon->output();
    EXPECT_TRUE(daemon->tells("recording-stopped"));
    EXPECT_THAT(daemon->output(), HasSubstr(what));
    daemon->signal(SIGTERM);
    EXPECT_EQ(5, daemon->wait()) << daemon->output();
    EXPECT_THAT(daemon->output(), HasSubstr("recording INCOMPLETE in " + path("run.mcap")));
    EXPECT_THAT(daemon->output(), testing::Not(HasSubstr("recorded ")));
    EXPECT_THAT(daemon->output(), HasSubstr(" 0 reports dropped"));
  }
  std::uintmax_t size(const std::string& name) const {
    std::error_code missing;
    const std::uintmax_t bytes = std::filesystem::file_size(folder / name, missing);
    return missing ? 0 : bytes;
  }
  int replay(const std::string& name, std::string& output) const {
    ChildProcess child(kReplay, {"check", path(name)});
    const int status = child.wait();
    output = child.output();
    return status;
  }

  ScratchFolder folder;
  CellFile cell;
  Cell read = cell.cell();
  DdsOptions dds = own_dds();
  Participant client{dds};
  Distances distances{client, read};
  dds_entity_t health = client.reader(TopicKind::kHealth, read.topics.health);
  std::optional<ChildProcess> daemon;
};

TEST_F(RecordingDaemon, RecordsWhatAnOfflineReplayGivesAgain) {
  ChildProcess robot(kRobot, with({cell.path(), "--rate", "300"}, dds_arguments(dds)));
  ChildProcess run(kDaemon, with({cell.path(), "--record", path("run.mcap"), "--ticks", "150"},
                                 dds_arguments(dds)));
  EXPECT_EQ(0, run.wait()) << run.output();
  EXPECT_TRUE(run.wrote("recorded ")) << run.output();
  ChildProcess compared(kReplay, {"check", path("run.mcap"), "--compare"});
  EXPECT_EQ(0, compared.wait()) << compared.output();
  EXPECT_TRUE(compared.wrote("150 reports compared")) << compared.output();
}

TEST_F(RecordingDaemon, StampsReportsWhenTheTickHandedThemOver) {
  const std::int64_t before = SystemClock().realtime_ns();
  ChildProcess run(kDaemon, with({cell.path(), "--record", path("run.mcap"), "--ticks", "20"},
                                 dds_arguments(dds)));
  EXPECT_EQ(0, run.wait()) << run.output();
  const std::int64_t after = SystemClock().realtime_ns();
  std::int64_t last = before;
  for (const Kept& message : messages_of(folder / "run.mcap")) {
    if (message.kind != TopicKind::kDistances) continue;
    const auto report = decoded<clearance_msg_Distances>(message);
    EXPECT_GE(report->publish_ns, report->now_ns);
    EXPECT_GE(report->publish_ns, last);
    last = report->publish_ns;
  }
  EXPECT_GT(last, before);
  EXPECT_LE(last, after);
}

TEST_F(RecordingDaemon, StartsAgainAfterACrashAndKeepsWhatWasRecorded) {
  start();
  ASSERT_TRUE(health_says("recording " + path("run.mcap"))) << daemon->output();
  ASSERT_TRUE(eventually([&] { return size("run.mcap") > 50'000; }));
  daemon->signal(SIGKILL);
  daemon->wait();
  start();
  EXPECT_TRUE(health_says("recording " + path("run-2.mcap"))) << daemon->output();
  EXPECT_TRUE(daemon->tells("recording-renamed", {path("run.mcap"), path("run-2.mcap")}));
  daemon->signal(SIGTERM);
  EXPECT_EQ(0, daemon->wait()) << daemon->output();
  std::string output;
  EXPECT_EQ(5, replay("run.mcap", output)) << output;
  EXPECT_THAT(output, HasSubstr("cut off"));
  EXPECT_THAT(output, testing::ContainsRegex("[1-9][0-9]+ ticks, ")) << "nothing is left of it";
  EXPECT_EQ(0, replay("run-2.mcap", output)) << output;
  ChildProcess third(kDaemon, with({cell.path(), "--record", path("run.mcap"), "--ticks", "1"},
                                   dds_arguments(dds)));
  EXPECT_EQ(0, third.wait()) << third.output();
  EXPECT_GT(size("run-3.mcap"), 0u);
}

TEST_F(RecordingDaemon, RefusesWhatIsNoRegularFileAtOnce) {
  ASSERT_EQ(0, mkfifo(path("pipe").c_str(), 0600));
  std::filesystem::create_directory(folder / "folder");
  for (const char* name : {"pipe", "folder"}) {
    for (const bool force : {false, true}) {
      std::vector<std::string> arguments{cell.path(), "--record", path(name)};
      if (force) arguments.push_back("--force");
      ChildProcess refused(kDaemon, with(arguments, dds_arguments(dds)));
      EXPECT_EQ(5, refused.wait()) << name;
      EXPECT_THAT(refused.output(), HasSubstr("expected ")) << name;
      EXPECT_THAT(refused.output(), HasSubstr(path(name)));
    }
  }
  ChildProcess recorder(kRecord, with({"-o", path("pipe"), "--force"}, dds_arguments(dds)));
  EXPECT_EQ(1, recorder.wait());
  EXPECT_THAT(recorder.output(), HasSubstr("it is no regular file; expected one"));
}

TEST_F(RecordingDaemon, TellsThatItsFileWasDeleted) {
  start();
  std::filesystem::remove(folder / "run.mcap");
  expect_told("was deleted while it was being written");
}

TEST_F(RecordingDaemon, TellsThatItsFileWasCutOff) {
  start();
  ASSERT_TRUE(eventually([&] { return size("run.mcap") > 50'000; }));
  std::filesystem::resize_file(folder / "run.mcap", 10'000);
  expect_told("was changed by another program while it was being written");
}

TEST_F(RecordingDaemon, TellsThatItsFileWasReplaced) {
  start();
  std::filesystem::rename(folder / "run.mcap", folder / "kept");
  write_text(folder / "run.mcap", "somebody else's");
  expect_told("was moved or replaced while it was being written");
  EXPECT_EQ("somebody else's", read_text(folder / "run.mcap"));
}

TEST_F(RecordingDaemon, TellsThatItsDiskIsFull) {
  start({.most_file_bytes = 100'000});
  expect_told("cannot write to " + path("run.mcap"));
  std::string output;
  EXPECT_EQ(5, replay("run.mcap", output)) << output;
  EXPECT_THAT(output, testing::ContainsRegex("[1-9][0-9]+ ticks, "));
}

// A disk that accepts nothing any more, such as a network file system that is unreachable: write()
// does not return.
TEST_F(RecordingDaemon, PublishesAndEndsWithADiskThatHangs) {
  if (kNoHangingDisk) GTEST_SKIP() << "no preloading with sanitizers";
  start_on_a_disk_that_may_hang();
  write_text(folder / "hang", "");
  expect_reports(200);
  daemon->signal(SIGTERM);
  EXPECT_EQ(5, daemon->wait(std::chrono::seconds(20))) << daemon->output();
  EXPECT_TRUE(daemon->tells("disk-hangs")) << daemon->output();
  EXPECT_THAT(daemon->output(), HasSubstr("recording INCOMPLETE"));
  EXPECT_THAT(daemon->output(), HasSubstr(" 0 reports dropped"));
}

// The queue before the disk holds a thousand reports. A fast daemon fills it in a second.
class FastRecordingDaemon : public RecordingDaemon {
 protected:
  FastRecordingDaemon() : RecordingDaemon(small_cell_at("1000")) {}

  static std::string small_cell_at(const std::string& rate_hz) {
    std::string text = small_cell("small");
    return text.replace(text.find("200"), 3, rate_hz);
  }
};

TEST_F(FastRecordingDaemon, CountsWhatADiskIsTooSlowFor) {
  if (kNoHangingDisk) GTEST_SKIP() << "no preloading with sanitizers";
  start_on_a_disk_that_may_hang();
  write_text(folder / "hang", "");
  EXPECT_TRUE(health_says("recording " + path("run.mcap"), 1)) << daemon->output();
  EXPECT_TRUE(daemon->tells("disk-too-slow"));
  std::filesystem::remove(folder / "hang");
  daemon->signal(SIGTERM);
  EXPECT_EQ(5, daemon->wait()) << daemon->output();
  EXPECT_THAT(daemon->output(), HasSubstr("the disk was too slow; "));
  std::string output;
  EXPECT_EQ(0, replay("run.mcap", output)) << output;
}

// Records by event. A robot that falls silent is the event.
class EventRecordingDaemon : public RecordingDaemon {
 protected:
  void start_by_event(const std::string& seconds, const ChildOptions& options = {}) {
    daemon.emplace(kDaemon,
                   with({cell.path(), "--record", path("run.mcap"), "--record-around", seconds,
                         "--record-uncompressed"},
                        dds_arguments(dds)),
                   options);
    distances.settle();
  }
  // The robot moves until a report knows all pairs, and is then ended.
  void let_a_robot_fall_silent() {
    ChildProcess robot(kRobot, with({cell.path(), "--rate", "300"}, dds_arguments(dds)));
    ASSERT_TRUE(eventually([&] {
      const auto report = distances.next();
      return report != nullptr && (*report)->unknown == 0 && (*report)->stale == 0;
    })) << daemon->output();
    robot.signal(SIGTERM);
    robot.wait();
  }
  std::vector<std::string> files() const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder / ".")) {
      const std::string name = entry.path().filename();
      if (name.starts_with("run-")) found.push_back(name);
    }
    std::ranges::sort(found);
    return found;
  }
  int replay_of_event(const std::string& name, std::string& output) const {
    ChildProcess child(kReplay, {"check", path(name), "--compare-bounds"});
    const int status = child.wait();
    output = child.output();
    return status;
  }
};

TEST_F(EventRecordingDaemon, WritesAFileForARobotThatFallsSilent) {
  start_by_event("0.5");
  let_a_robot_fall_silent();
  ASSERT_TRUE(daemon->tells("event-recorded")) << daemon->output();
  daemon->signal(SIGTERM);
  EXPECT_EQ(0, daemon->wait()) << daemon->output();
  EXPECT_FALSE(std::filesystem::exists(folder / "run.mcap"));
  ASSERT_FALSE(files().empty());
  for (const std::string& file : files()) {
    std::string output;
    EXPECT_EQ(0, replay_of_event(file, output)) << output;
  }
}

// A killed daemon leaves the file of its event, which is read up to the last chunk, and the next
// run leaves that file alone.
TEST_F(EventRecordingDaemon, LeavesWhatWasRecordedWhenItIsKilledInBetween) {
  start_by_event("30");
  let_a_robot_fall_silent();
  ASSERT_TRUE(daemon->tells("event-recorded")) << daemon->output();
  ASSERT_TRUE(eventually([&] { return !files().empty() && size(files()[0]) > 50'000; }));
  daemon->signal(SIGKILL);
  daemon->wait();
  const std::vector<std::string> before = files();
  const std::uintmax_t bytes = size(before[0]);
  std::string output;
  EXPECT_EQ(5, replay_of_event(before[0], output)) << output;
  EXPECT_THAT(output, HasSubstr("cut off"));
  EXPECT_THAT(output, testing::ContainsRegex("[1-9][0-9]+ ticks, "));
  start_by_event("0.5");
  let_a_robot_fall_silent();
  EXPECT_TRUE(eventually([&] { return files().size() > before.size(); })) << daemon->output();
  daemon->signal(SIGTERM);
  EXPECT_EQ(0, daemon->wait()) << daemon->output();
  EXPECT_EQ(bytes, size(before[0]));
}

TEST_F(EventRecordingDaemon, TellsThatTheDiskIsFullWhenItWritesAnEvent) {
  start_by_event("30", {.most_file_bytes = 100'000});
  let_a_robot_fall_silent();
  expect_told("cannot write to " + path("run-"));
}

TEST_F(EventRecordingDaemon, RefusesAFolderThatIsMissing) {
  ChildProcess refused(
      kDaemon, with({cell.path(), "--record", path("none/run.mcap"), "--record-around", "1"},
                    dds_arguments(dds)));
  EXPECT_EQ(5, refused.wait()) << refused.output();
  EXPECT_THAT(refused.output(), HasSubstr(path("none")));
}

TEST_F(RecordingDaemon, NeverRecordsOverItsCell) {
  ChildProcess over(kDaemon,
                    with({cell.path(), "--record", cell.path(), "--force"}, dds_arguments(dds)));
  EXPECT_EQ(2, over.wait());
  EXPECT_TRUE(over.wrote("is a file that is read")) << over.output();
  EXPECT_EQ("small", cell.cell().scene.name);
}

}  // namespace
}  // namespace clearance::test
