#include "monitor/replay/offline_replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "monitor/recording/csv_recording.hpp"
#include "monitor/replay/report_csv.hpp"
#include "monitor/replay/report_recorder.hpp"
#include "tests/monitor/replay/offline_replay_run.hpp"

namespace clearance::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

TEST_F(OfflineReplayTest, SameRecordingTwiceGivesIdenticalBytes) {
  record_run(cell, run);
  for (const char* name : {"a.mcap", "b.mcap"}) {
    ReportRecorder out(folder / name, cell);
    ASSERT_TRUE(
        replay_offline(cell, run, {}, [&out](const ReplayedTick& tick) { out.add(tick); }).ok());
    ASSERT_TRUE(out.close());
  }
  EXPECT_EQ(read_text(folder / "a.mcap"), read_text(folder / "b.mcap"));
  EXPECT_EQ(200,
            std::ranges::count(messages_of(folder / "a.mcap"), TopicKind::kDistances, &Kept::kind));
}

TEST_F(OfflineReplayTest, EndsWhereItIsToldToStopAndSaysSo) {
  record_run(cell, run);
  int ticks = 0;
  const OfflineReplay result = replay_offline(
      cell, run, {.expect_min_distance = 0.01, .stop = [&ticks] { return ticks == 50; }},
      [&ticks](const ReplayedTick&) { ++ticks; });
  EXPECT_TRUE(result.stopped);
  EXPECT_EQ(50, ticks);
  EXPECT_EQ(50u, result.ticks);
  EXPECT_THAT(result.text(), HasSubstr("stopped after 50 ticks: nothing is known of the rest"));
  EXPECT_TRUE(result.ok()) << result.text();
}

TEST_F(OfflineReplayTest, StoppedBeforeTheFirstTickItFindsNoFault) {
  record_run(cell, run);
  const OfflineReplay result =
      replay({.start_s = 0.1, .compare = Comparison::kBits, .stop = [] { return true; }});
  EXPECT_TRUE(result.stopped);
  EXPECT_TRUE(result.ok()) << result.text();
}

TEST_F(OfflineReplayTest, WindowIsWhatIsHandedOutButAllIsRun) {
  record_run(cell, run);
  std::vector<std::uint64_t> cycles;
  const OfflineReplay result =
      replay_offline(cell, run, {.start_s = 0.05, .end_s = 0.06, .compare = Comparison::kBits},
                     [&cycles](const ReplayedTick& tick) { cycles.push_back(tick.report.cycle); });
  EXPECT_TRUE(result.ok()) << result.text();
  ASSERT_EQ(11u, cycles.size());
  EXPECT_EQ(51u, cycles.front());
  EXPECT_EQ(11u, result.ticks);
  EXPECT_EQ(10 * kTick, result.last_ns - result.first_ns);
  EXPECT_EQ(11u, result.compared);
}

TEST_F(OfflineReplayTest, RecordingCutOffIsReplayedUpToThere) {
  record_run(cell, run, {.ticks = 1000});
  const std::string whole = read_text(run);
  write_text(run, whole.substr(0, whole.size() / 2));
  const OfflineReplay result = replay({.compare = Comparison::kBits});
  EXPECT_TRUE(result.ok()) << result.text();
  EXPECT_THAT(result.damage, HasSubstr("cut off"));
  EXPECT_GT(result.compared, 400u);
  EXPECT_LT(result.compared, 600u);
}

TEST_F(OfflineReplayTest, AnotherCellIsServedByName) {
  record_run(cell, run);
  Scene other = cell_of({fixed("table", {floor()}, at(0, 0, -1)),
                         moving("Tool", {capsule(0.2, 0.02)}), moving("hand", {ball(0.05)})});
  other.revision = 99;
  for (Object& object : other.objects) object.max_speed = 2.0;
  std::vector<double> seen;
  const OfflineReplay result = replay_offline({other}, run, {}, [&seen](const ReplayedTick& tick) {
    seen.push_back(tick.monitor.pair(1).distance);  // table - hand
  });
  EXPECT_TRUE(result.ok());
  EXPECT_THAT(result.notes,
              Contains(HasSubstr("object 'tool' of the recording is not in the cell")));
  EXPECT_THAT(result.notes, Contains(HasSubstr("did you mean 'Tool'")));
  EXPECT_THAT(result.notes,
              Contains(HasSubstr("object 'Tool' of the cell is not in the recording")));
  EXPECT_NEAR(1.0 + 0.1 + 0.08, *std::ranges::min_element(seen), 1e-9);
  EXPECT_THAT(replay_offline({other}, run, {.compare = Comparison::kBits}).error,
              HasSubstr("another cell"));
}

TEST_F(OfflineReplayTest, CellOfOtherObjectsIsAnError) {
  record_run(cell, run);
  Scene other = cell_of({moving("cart", {ball(0.1)}), fixed("hand", {ball(0.1)}, at(0, 0, 3))});
  other.revision = 99;
  const OfflineReplay result = replay_offline({other}, run);
  EXPECT_THAT(result.error, HasSubstr("no object that moves in this cell"));
  EXPECT_THAT(result.error, HasSubstr("object 'tool' of the recording is not in the cell"));
}

TEST_F(OfflineReplayTest, WindowWithoutATickIsNoProof) {
  record_run(cell, run);
  for (const OfflineReplayOptions& options : {OfflineReplayOptions{.start_s = 100.0},
                                              {.start_s = 100.0, .expect_min_distance = 0.01},
                                              {.start_s = 100.0, .compare = Comparison::kBits}}) {
    EXPECT_THAT(replay(options).error,
                HasSubstr("no tick lies between the start and the end given: the recording lasts "
                          "0.199"));
  }
}

TEST_F(OfflineReplayTest, PoseLogWithoutReportsTicksOnceADistinctTime) {
  write_text(folder / "log.csv",
             "t_ns,object,px,py,pz,qw,qx,qy,qz\n"
             "1000000,hand,0,0,0.5,1,0,0,0\n1000000,tool,1,1,1,1,0,0,0\n"
             "2000000,hand,0,0,0.4,1,0,0,0\n"
             "5000000,hand,0,0,0.3,1,0,0,0\n5000000,tool,1,1,1,1,0,0,0\n");
  ASSERT_EQ("", record_csv(folder / "log.csv", run, nullptr).error);
  std::vector<std::int64_t> times;
  std::vector<double> distances;
  const OfflineReplay result = replay_offline(cell, run, {}, [&](const ReplayedTick& tick) {
    times.push_back(tick.report.now_ns);
    distances.push_back(tick.report.minimum.distance);
  });
  EXPECT_TRUE(result.ok()) << result.text();
  EXPECT_THAT(times, testing::ElementsAre(1'000'000, 2'000'000, 5'000'000));
  ASSERT_EQ(3u, distances.size());
  EXPECT_NEAR(0.35, distances[0], 1e-12);
  EXPECT_NEAR(0.25, distances[1], 1e-12);
  EXPECT_NEAR(0.15, distances[2], 1e-12);
  EXPECT_THAT(replay({.compare = Comparison::kBits}).error, HasSubstr("holds no reports"));
}

TEST_F(OfflineReplayTest, TableHasOneRowATickAndPair) {
  record_run(cell, run, {.ticks = 5});
  for (const bool all : {false, true}) {
    ReportCsv csv(folder / "t.csv", scene, all);
    ASSERT_TRUE(
        replay_offline(cell, run, {}, [&csv](const ReplayedTick& tick) { csv.add(tick); }).ok());
    ASSERT_TRUE(csv.close());
    const std::string text = read_text(folder / "t.csv");
    EXPECT_EQ(1 + 5 * (all ? 3 : 2), std::ranges::count(text, '\n'));
    EXPECT_THAT(text, HasSubstr("tick,now_ns,object_a,object_b,status,distance,lower,upper,swept_"
                                "lower,model_error,stop_lower,ax"));
    EXPECT_THAT(
        text,
        HasSubstr(",age_a_ns,age_b_ns,refresh_age_cycles,scene_revision,contact,contact_status,"
                  "contact_depth,blind_shell,unseen\n"));
    EXPECT_THAT(text, HasSubstr("\n1,1700000000000000000,hand,tool,converged,"));
    EXPECT_THAT(text, HasSubstr(",0,0000000000000029,,,,,\n5,"))
        << "published pairs are refreshed in every tick";
  }
}

TEST_F(OfflineReplayTest, TableHasTheContactsOfTheirPairs) {
  scene.contacts.push_back({"lift, \"1\"", "", "", 0.02, {}, "", "", {1}});
  record_run(cell, run, {.nearest = -0.01});
  ReportCsv csv(folder / "t.csv", scene, true);
  ASSERT_TRUE(
      replay_offline(cell, run, {}, [&csv](const ReplayedTick& tick) { csv.add(tick); }).ok());
  ASSERT_TRUE(csv.close());
  const std::string text = read_text(folder / "t.csv");
  std::size_t touching = 0, rows = 0;
  for (std::size_t at = 0; (at = text.find(",\"lift, \"\"1\"\"\",allowed,", at)) != text.npos;
       ++at) {
    ++rows;
    const std::size_t end = text.find(",,\n", at);  // no columns of sensors
    const double depth = std::stod(text.substr(text.rfind(',', end - 1) + 1));
    EXPECT_LE(depth, 0.02);
    touching += depth > 0.0;
  }
  EXPECT_EQ(200u, rows);
  EXPECT_GT(touching, 0u);
}

TEST_F(OfflineReplayTest, UnreadableRecordingIsAnError) {
  write_text(run, "not a recording");
  EXPECT_THAT(replay().error, HasSubstr("is not an MCAP file"));
  EXPECT_FALSE(replay().ok());
}

TEST_F(OfflineReplayTest, ProgressRunsFromNothingToAll) {
  record_run(cell, run, {.ticks = 1000});
  std::vector<double> shares;
  ASSERT_TRUE(replay({.progress = [&shares](double share) { shares.push_back(share); }}).ok());
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_GT(shares.size(), 3u);
  EXPECT_LE(shares.size(), 103u);
  EXPECT_EQ(1.0, shares.back());
}

}  // namespace
}  // namespace clearance::test
