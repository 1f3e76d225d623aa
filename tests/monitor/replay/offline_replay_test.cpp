#include "monitor/replay/offline_replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "monitor/files/build_info.hpp"
#include "monitor/recording/csv_recording.hpp"
#include "monitor/replay/report_csv.hpp"
#include "monitor/replay/report_recorder.hpp"
#include "tests/monitor/replay/offline_replay_run.hpp"

namespace clearance::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST_F(OfflineReplayTest, GivesTheRecordedReportsBitForBit) {
  record_run(cell, run);
  const OfflineReplay result = replay({.compare = Comparison::kBits});
  EXPECT_TRUE(result.ok()) << result.text();
  EXPECT_EQ("", result.text());
  EXPECT_EQ(200u, result.ticks);
  EXPECT_EQ(200u, result.compared);
  EXPECT_GT(result.batches, 200u);
}

TEST_F(OfflineReplayTest, WhatIsUnknownIsTheSameWhateverItsBits) {
  record_run(cell, run);
  int unknown = 0;
  rewrite([&](std::vector<Kept>& messages) {
    Kept& first = messages[report_of(messages, 1)];
    first = altered<clearance_msg_Distances>(first, [&](clearance_msg_Distances& report) {
      unknown = std::isnan(report.minimum.closing_speed);
      report.minimum.closing_speed = -report.minimum.closing_speed;
    });
  });
  ASSERT_EQ(1, unknown);
  EXPECT_EQ("", replay({.compare = Comparison::kBits}).text());
}

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

TEST_F(OfflineReplayTest, ADifferenceNamesTheBuildsWhereTheyAreNotTheSame) {
  record_run(cell, run);
  EXPECT_EQ(kBuild, outline(run).build);
  std::vector<Kept> messages = messages_of(run);
  Kept& report = messages[report_of(messages, 5)];
  const Kept untouched = report;
  report = altered<clearance_msg_Distances>(
      report, [](clearance_msg_Distances& content) { ++content.queries; });
  const auto text_of_a_run_by = [&](const std::string& build) {
    write_messages(run, messages, build);
    return replay({.compare = Comparison::kBits}).text();
  };
  const std::string ours = kBuild;
  EXPECT_THAT(text_of_a_run_by("0.0.1"),
              HasSubstr("; it was recorded by another build (0.0.1), which may be the reason: this "
                        "is " +
                        ours));
  EXPECT_THAT(text_of_a_run_by(""),
              HasSubstr("; the recording does not name its build: if that is not this one (" +
                        ours + "), it may be the reason"));
  EXPECT_THAT(text_of_a_run_by(kBuild),
              AllOf(HasSubstr("differs in queries"), Not(HasSubstr("build"))));
  report = untouched;
  EXPECT_EQ("", text_of_a_run_by("0.0.1"));
}

TEST_F(OfflineReplayTest, AZoneThatDiffersNamesTheBuildsToo) {
  record_run(cell, run);
  std::vector<Kept> messages = messages_of(run);
  std::erase_if(messages, [](const Kept& message) { return message.kind == TopicKind::kZones; });
  write_messages(run, messages, "0.0.1");
  EXPECT_THAT(replay({.compare = Comparison::kBits}).text(),
              HasSubstr("recorded by another build (0.0.1)"));
}

// The hand belongs to a person, the tool to a robot.
void separate(Scene& scene) {
  Zone& zone = scene.zones[0];
  zone.pairs = {0};
  zone.separation.emplace();
  zone.separation->human_is_first = {1};
  zone.separation->reaction_time_ns = 100'000'000;
}

TEST_F(OfflineReplayTest, GivesSeparationsAgainToTheBitAndNamesTheFirstThatDiffers) {
  separate(scene);
  record_run(cell, run);
  EXPECT_EQ("", replay({.compare = Comparison::kBits}).text());
  std::vector<Kept> messages = messages_of(run);
  EXPECT_EQ(200, std::ranges::count(messages, TopicKind::kSeparation, &Kept::kind));
  // The message before the report of tick 5.
  Kept& separation = messages[report_of(messages, 5) - 1];
  ASSERT_EQ(separation.kind, TopicKind::kSeparation);
  separation = altered<clearance_msg_Separation>(separation, [](clearance_msg_Separation& content) {
    content.pairs._buffer[0].scaling += 1e-9;
  });
  write_messages(run, messages);
  EXPECT_THAT(
      replay({.compare = Comparison::kBits}).text(),
      AllOf(HasSubstr("tick 5 "),
            HasSubstr("differs in separation.pairs[0] (zone 'stop', hand - tool).scaling: ")));
}

// In a recording over DDS, topics may be out of order.
TEST_F(OfflineReplayTest, FindsASeparationBehindItsReport) {
  separate(scene);
  record_run(cell, run);
  std::vector<Kept> messages = messages_of(run);
  for (std::size_t i = 0; i + 1 < messages.size(); ++i) {
    if (messages[i].kind == TopicKind::kSeparation) std::swap(messages[i], messages[i + 1]), ++i;
  }
  Kept& separation = messages[report_of(messages, 7) + 1];
  ASSERT_EQ(separation.kind, TopicKind::kSeparation);
  separation = altered<clearance_msg_Separation>(separation, [](clearance_msg_Separation& content) {
    content.zones._buffer[0].remaining -= 1e-9;
  });
  write_messages(run, messages);
  EXPECT_THAT(replay({.compare = Comparison::kBits}).text(),
              AllOf(HasSubstr("tick 7 "),
                    HasSubstr("separation.zones[0] (zone 'stop', hand - tool).remaining: ")));
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

TEST_F(OfflineReplayTest, NamesTheFirstTickAndFieldThatDiffers) {
  record_run(cell, run);
  rewrite([](std::vector<Kept>& messages) {
    for (const int tick : {58, 60}) {
      Kept& message = messages[report_of(messages, tick)];
      message = altered<clearance_msg_Distances>(message, [](clearance_msg_Distances& report) {
        report.pairs._buffer[1].witness_a.y =
            std::nextafter(report.pairs._buffer[1].witness_a.y, 9.0);
      });
    }
  });
  const OfflineReplay result = replay({.compare = Comparison::kBits});
  ASSERT_EQ(1u, result.failures.size()) << result.text();
  EXPECT_EQ(58u, result.failures[0].tick.cycle);
  EXPECT_EQ(kStart + 57 * kTick, result.failures[0].now_ns);
  EXPECT_THAT(result.failures[0].what, HasSubstr("pairs[1] (hand - box).witness_a.y: recorded "));
}

TEST_F(OfflineReplayTest, BoundsThatOverlapAreTheSameWhereOnlyTheCertainIsCompared) {
  record_run(cell, run);
  rewrite([](std::vector<Kept>& messages) {
    Kept& message = messages[report_of(messages, 58)];
    message = altered<clearance_msg_Distances>(
        message, [](clearance_msg_Distances& report) { report.minimum.lower -= 1e-9; });
  });
  EXPECT_FALSE(replay({.compare = Comparison::kBits}).ok());
  EXPECT_TRUE(replay({.compare = Comparison::kBounds}).ok());
  rewrite([](std::vector<Kept>& messages) {
    Kept& message = messages[report_of(messages, 58)];
    message = altered<clearance_msg_Distances>(message, [](clearance_msg_Distances& report) {
      report.minimum.lower += 1e-3;
      report.minimum.upper += 1e-3;
    });
  });
  const OfflineReplay result = replay({.compare = Comparison::kBounds});
  ASSERT_EQ(1u, result.failures.size());
  EXPECT_THAT(result.failures[0].what, HasSubstr("minimum"));
}

TEST_F(OfflineReplayTest, FindsTheBatchesThatStandFarBehindTheirReport) {
  record_run(cell, run);
  rewrite([](std::vector<Kept>& messages) {
    for (Kept& message : messages) {
      if (message.kind == TopicKind::kPoses) message.log_ns += 100 * kTick;
    }
    std::ranges::stable_sort(messages, {}, &Kept::log_ns);
  });
  const OfflineReplay result = replay({.compare = Comparison::kBits});
  EXPECT_TRUE(result.ok()) << result.text();
}

TEST_F(OfflineReplayTest, UsesNoBatchThatNoReportNames) {
  record_run(cell, run);
  rewrite([this](std::vector<Kept>& messages) {
    const auto first = std::ranges::find(messages, TopicKind::kPoses, &Kept::kind);
    messages.insert(first + 1,
                    altered<clearance_msg_PoseBatch>(*first, [](clearance_msg_PoseBatch& batch) {
                      std::strcpy(batch.source, "ghost");
                      batch.poses._buffer[0].position = {0.0, 0.0, 0.0};
                      ++batch.poses._buffer[0].stamp_ns;
                    }));
  });
  const OfflineReplay result = replay({.compare = Comparison::kBits});
  EXPECT_TRUE(result.ok()) << result.text();
}

TEST_F(OfflineReplayTest, BatchThatWasLostIsToldAndChangesTheReplay) {
  record_run(cell, run);
  rewrite([](std::vector<Kept>& messages) {
    std::size_t at = report_of(messages, 40);
    while (messages[at].kind != TopicKind::kPoses ||
           std::string_view(decoded<clearance_msg_PoseBatch>(messages[at])->source) != "arm") {
      ++at;
    }
    messages.erase(messages.begin() + static_cast<std::ptrdiff_t>(at));
  });
  const OfflineReplay result = replay({.compare = Comparison::kBits});
  EXPECT_FALSE(result.ok());
  EXPECT_THAT(result.text(), HasSubstr("the replay differs in"));
}

TEST_F(OfflineReplayTest, ZoneChangeThatIsNotRecordedIsNamed) {
  record_run(cell, run, {.nearest = 0.05});
  std::uint64_t cycle = 0;
  rewrite([&cycle](std::vector<Kept>& messages) {
    auto zone = std::ranges::find_if(messages, [](const Kept& message) {
      return message.kind == TopicKind::kZones && decoded<clearance_msg_ZoneState>(message)->active;
    });
    ASSERT_NE(messages.end(), zone);
    cycle = decoded<clearance_msg_ZoneState>(*zone)->cycle;
    messages.erase(zone);
  });
  const OfflineReplay result = replay({.compare = Comparison::kBits});
  ASSERT_EQ(1u, result.failures.size()) << result.text();
  EXPECT_EQ(cycle, result.failures[0].tick.cycle);
  EXPECT_THAT(result.failures[0].what,
              HasSubstr("zone 'stop': recorded no change, replayed active"));
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
  EXPECT_EQ(200u, result.ticks);
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

TEST_F(OfflineReplayTest, DaemonThatWasStartedAnewBeginsWithAMonitorThatKnowsNothing) {
  record_run(cell, run, {.ticks = 60});
  rewrite([](std::vector<Kept>& messages) {
    std::vector<Kept> again = messages;
    for (Kept& message : again) message.log_ns += 1000 * kTick;
    messages.insert(messages.end(), again.begin(), again.end());
  });
  const OfflineReplay result = replay({.compare = Comparison::kBits});
  EXPECT_TRUE(result.ok()) << result.text();
  EXPECT_EQ(120u, result.compared);
  EXPECT_THAT(result.notes, Contains(HasSubstr("started anew")));
}

TEST_F(OfflineReplayTest, RecordingThatBeginsLateIsComparedInWhatIsCertain) {
  record_run(cell, run);
  rewrite([](std::vector<Kept>& messages) {
    messages.erase(messages.begin() + 1,
                   messages.begin() + static_cast<std::ptrdiff_t>(report_of(messages, 50)) + 1);
  });
  const OfflineReplay result = replay({.compare = Comparison::kBounds});
  EXPECT_TRUE(result.ok()) << result.text();
  EXPECT_EQ(150u, result.compared);
  EXPECT_THAT(result.notes, Contains(HasSubstr("begins at tick 51 of the daemon")));
  EXPECT_EQ(result.closest_tick.cycle + 50, result.closest_tick.recorded);
}

TEST_F(OfflineReplayTest, TicksThatTheDaemonCountsOtherwiseAreNamedByBoth) {
  EXPECT_EQ("tick 12", (TickNumber{12, 12}.text()));
  EXPECT_EQ("tick 12 of the replay, 4012 of the daemon", (TickNumber{12, 4012}.text()));
}

TEST_F(OfflineReplayTest, TicksWhosePosesWereLostAreNotComparedInWhatIsCertain) {
  record_run(cell, run);
  rewrite([](std::vector<Kept>& messages) {
    std::size_t place = report_of(messages, 50);
    while (messages[place].kind != TopicKind::kPoses) --place;
    messages.erase(messages.begin() + static_cast<std::ptrdiff_t>(place));
  });
  const OfflineReplay some = replay({.compare = Comparison::kBounds});
  EXPECT_TRUE(some.ok()) << some.text();
  EXPECT_LT(some.compared, 200u);
  EXPECT_GT(some.compared, 150u);
  EXPECT_THAT(some.notes, Contains(HasSubstr("1 batches that a tick used are not in")));
  rewrite([](std::vector<Kept>& messages) {
    std::erase_if(messages, [](const Kept& m) { return m.kind == TopicKind::kPoses; });
  });
  const OfflineReplay none = replay({.compare = Comparison::kBounds});
  ASSERT_EQ(1u, none.failures.size()) << none.text();
  EXPECT_THAT(none.failures[0].what, HasSubstr("no report could be compared"));
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
    EXPECT_THAT(
        text,
        HasSubstr("tick,now_ns,object_a,object_b,status,distance,lower,upper,swept_lower,ax"));
    EXPECT_THAT(text, HasSubstr(",age_a_ns,age_b_ns,refresh_age_cycles\n"));
    EXPECT_THAT(text, HasSubstr("\n1,1700000000000000000,hand,tool,converged,"));
    EXPECT_THAT(text, HasSubstr(",0\n5,")) << "published pairs are refreshed in every tick";
  }
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
