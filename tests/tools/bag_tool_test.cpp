// clearance-replay and clearance-record on bags and joint logs, as a person runs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "monitor/files/numbered_file.hpp"
#include "tests/monitor/recording/ros_bags.hpp"
#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;
using testing::Not;

const char* const kSrdf = R"(<robot name="scara">
  <disable_collisions link1="foot" link2="upper" reason="Adjacent"/>
  <disable_collisions link1="upper" link2="lower" reason="Adjacent"/>
  <disable_collisions link1="lower" link2="finger" reason="Adjacent"/>
</robot>
)";

// The elbow folds the lower arm back over the upper one, and the finger slides out.
std::vector<RosMessage> folding(double most) {
  std::vector<RosMessage> messages;
  for (int i = 0; i <= 200; ++i) {
    const std::int64_t t = kStart + i * 5'000'000;
    messages.push_back(joint_state(
        t, t, {{"shoulder", "elbow", "push"}, {0.5, most * i / 200, 0.1}, {0.0, most, 0.0}}));
  }
  return messages;
}

class BagTool : public RunsPrograms {
 protected:
  BagTool() {
    write_text(folder / "R.urdf", kScaraUrdf);
    write_text(folder / "R.srdf", kSrdf);
    std::filesystem::create_directory(folder / "bag");
    write_sqlite_bag(folder / "bag/bag_0.db3", folding(1.5));
  }
  int replay(const std::string& bag, const std::vector<std::string>& more) {
    return run(
        kReplay,
        with({"check", "--urdf", path("R.urdf"), "--srdf", path("R.srdf"), path(bag)}, more));
  }
};

TEST_F(BagTool, OneLineIsARegressionTestOfARobotProgram) {
  EXPECT_EQ(0, replay("bag", {"--expect-min-distance", "0.2"})) << output;
  EXPECT_THAT(output, HasSubstr("1001 ticks, 1.000 s recorded"));
  write_mcap_bag(folder / "worse.mcap", folding(3.0));
  EXPECT_EQ(1, replay("worse.mcap", {"--expect-min-distance", "0.2"}));
  EXPECT_THAT(output, HasSubstr("at least 0.2 m expected"));
  EXPECT_THAT(output, testing::ContainsRegex("tick [0-9]+ .*: upper - finger"));
}

TEST_F(BagTool, RobotIsTheOneThatTheBagDescribesUnlessItIsGiven) {
  std::vector<RosMessage> messages = folding(1.5);
  messages.insert(messages.begin() + 3, ros_text(kStart, kScaraUrdf, "/scara/robot_description"));
  write_mcap_bag(folder / "described.mcap", messages);
  const auto replayed = [&](const std::string& out) {
    EXPECT_EQ(0, run(kReplay, {"check", path("described.mcap"), "-o", path(out),
                               "--expect-min-distance", "0.05"}))
        << output;
    return read_text(folder / out);
  };
  EXPECT_EQ(replayed("a.mcap"), replayed("b.mcap"));
  EXPECT_EQ(0, run(kReplay, {"check", "--srdf", path("R.srdf"), path("described.mcap")})) << output;
}

TEST_F(BagTool, JointTableAndGivenJointsDo) {
  std::string table = "t_ns,shoulder,elbow\n";
  for (int i = 0; i < 100; ++i) table += std::to_string(i * 10'000'000) + ",0.5,0.2\n";
  write_text(folder / "log.csv", table);
  EXPECT_EQ(1, replay("log.csv", {"--expect-min-distance", "0.05"}));
  EXPECT_THAT(output, HasSubstr("never tells where 'finger' is"));
  EXPECT_THAT(output, HasSubstr("is unknown: push; --joint NAME=POSITION"));
  EXPECT_EQ(0, replay("log.csv", {"--expect-min-distance", "0.05", "--joint", "push=0.1"}))
      << output;
  EXPECT_EQ(2, replay("log.csv", {"--joint", "push"}));
  EXPECT_THAT(output, HasSubstr("found 'push'; expected NAME=POSITION"));
  EXPECT_EQ(1, replay("log.csv", {"--joint", "pusch=1"}));
  EXPECT_THAT(output, HasSubstr("did you mean 'push'?"));
}

TEST_F(BagTool, TellsWhatIsMissing) {
  EXPECT_EQ(1, run(kReplay, {"check", path("bag")}));
  EXPECT_THAT(output, HasSubstr("expected --urdf and --srdf"));
  write_mcap_bag(folder / "none.mcap", {ros_text(kStart, "x", "/chatter")});
  EXPECT_EQ(1, replay("none.mcap", {}));
  EXPECT_THAT(output, HasSubstr("there are /chatter (std_msgs/msg/String, 1 message)"));
  EXPECT_EQ(1, replay("nowhere.db3", {}));
  EXPECT_THAT(output, HasSubstr("nowhere.db3: No such file"));
  EXPECT_EQ(2, run(kReplay, {"publish", path("bag"), "--tick-hz", "100"}));
  EXPECT_EQ(1, run(kReplay, {"publish", path("bag")}));
  EXPECT_THAT(output, HasSubstr("'clearance-replay check' replays it as"));
}

TEST_F(BagTool, ConvertedBagReplaysToTheSameBytes) {
  write_text(folder / "cell.yaml",
             "name: c\nunits: {length: m, angle: rad}\nrobots: [{name: arm, urdf: R.urdf, srdf: "
             "R.srdf}]\npairs: [{between: [arm, arm]}]\n");
  ASSERT_EQ(0, run(kRecord, {"--from-bag", path("bag"), "-o", path("run.mcap"), "--cell",
                             path("cell.yaml")}))
      << output;
  EXPECT_THAT(output, HasSubstr("201 batches, 1.000 s"));
  const auto replayed = [&](const std::string& log, const std::string& out) {
    EXPECT_EQ(0, run(kReplay, {"check", "--cell", path("cell.yaml"), path(log), "--tick-hz", "500",
                               "-o", path(out)}))
        << output;
    return read_text(folder / out);
  };
  const std::string once = replayed("bag", "a.mcap");
  EXPECT_EQ(once, replayed("bag", "b.mcap"));
  EXPECT_EQ(once, replayed("run.mcap", "c.mcap"));
  EXPECT_EQ(2, run(kRecord, {"--from-bag", path("bag"), "-o", path("no.mcap")}));
  EXPECT_THAT(output, HasSubstr("--cell is missing"));
  write_text(folder / "log.csv", "t_ns,elbow\n1,0\n2,0\n");
  EXPECT_EQ(0, run(kRecord, {"--from-csv", path("log.csv"), "-o", path("csv.mcap"), "--cell",
                             path("cell.yaml")}))
      << output;
  EXPECT_THAT(output, HasSubstr("2 batches"));
}

// The daemon records in compressed form, in several files, with few pairs and without health.
TEST_F(BagTool, DaemonRecordsWhatItIsToldAndTheFilesCompareAsOne) {
  const CellFile cell(small_cell("small"));
  const DdsOptions dds = own_dds();
  ChildProcess robot(kRobot, with({cell.path(), "--rate", "300"}, dds_arguments(dds)));
  ASSERT_EQ(0, run(kDaemon, with({cell.path(), "--record", path("run.mcap"), "--ticks", "200",
                                  "--record-roll-s", "0.3", "--record-every", "50",
                                  "--record-without", "health"},
                                 dds_arguments(dds))))
      << output;
  EXPECT_THAT(output, HasSubstr("recording continues in " + path("run-2.mcap")));
  std::vector<std::string> files;
  for (auto file = folder / "run.mcap"; is_taken(file); file = next_number(file)) {
    files.push_back(file.string());
  }
  EXPECT_GE(files.size(), 3u);
  const std::vector<Kept> messages = messages_of(files[1]);
  EXPECT_EQ(0, std::ranges::count(messages, TopicKind::kHealth, &Kept::kind));
  EXPECT_EQ(0, run(kReplay, with(with({"check"}, files), {"--compare"}))) << output;
  EXPECT_THAT(output, HasSubstr("200 reports compared"));
}

TEST_F(BagTool, RecorderTakesTheSameOptions) {
  EXPECT_EQ(2, run(kRecord, {"-o", path("a.mcap"), "--without", "catalogue"}));
  EXPECT_THAT(output, HasSubstr("found 'catalogue'; expected 'poses', 'joint_states', "
                                "'distances', 'zones', 'health', 'separation' or 'gradients'"));
  const Cell cell{bench_cell()};
  record_run(cell, folder / "run.mcap", {.ticks = 60});
  const auto where = dds_arguments(own_dds());
  ChildProcess recorder(kRecord, with({"-o", path("again.mcap"), "--every", "20", "--without",
                                       "poses", "--uncompressed"},
                                      where));
  ASSERT_EQ(
      0, run(kReplay, with({"publish", path("run.mcap"), "--wait", "20", "--rate", "0.25"}, where)))
      << output;
  recorder.signal(SIGINT);
  EXPECT_EQ(0, recorder.wait()) << recorder.output();
  int whole = 0, thin = 0;
  for (const Kept& message : messages_of(folder / "again.mcap")) {
    EXPECT_NE(TopicKind::kPoses, message.kind);
    if (message.kind != TopicKind::kDistances) continue;
    const auto report = decoded<clearance_msg_Distances>(message);
    report->pairs._length > 0 ? ++whole : ++thin;
    EXPECT_EQ(report->cycle % 20 == 0, report->pairs._length > 0);
  }
  EXPECT_EQ(3, whole);
  EXPECT_GT(thin, 40);
}

}  // namespace
}  // namespace clearance::test
