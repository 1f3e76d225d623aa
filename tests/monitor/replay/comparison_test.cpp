// An offline replay beside the reports of its recording: which differences it finds, how it names
// them, and which gaps of a recording it allows for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "monitor/files/build_info.hpp"
#include "monitor/replay/zone_difference.hpp"
#include "monitor/tick/monitor.hpp"
#include "monitor/wire/convert.hpp"
#include "tests/monitor/replay/offline_replay_run.hpp"

namespace clearance::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
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
  std::erase_if(messages, [](const Kept& message) {
    return message.kind == TopicKind::kZones && decoded<clearance_msg_ZoneState>(message)->active;
  });
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
  for (const double farther : {1e-3, -2e-3}) {
    rewrite([farther](std::vector<Kept>& messages) {
      Kept& message = messages[report_of(messages, 58)];
      message = altered<clearance_msg_Distances>(message, [&](clearance_msg_Distances& report) {
        report.minimum.lower += farther;
        report.minimum.upper += farther;
      });
    });
    const OfflineReplay result = replay({.compare = Comparison::kBounds});
    ASSERT_EQ(1u, result.failures.size()) << farther;
    EXPECT_THAT(result.failures[0].what, HasSubstr("minimum"));
  }
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
  rewrite([](std::vector<Kept>& messages) {
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

// A replay counts its ticks from 1, and a recording may have begun later.
TEST(ZoneDifference, CountsBothCyclesOfAZoneAsTheDaemonDoes) {
  Scene scene = cell_of({moving("hand", {ball(0.1)}), moving("part", {ball(0.1)})});
  scene.zones.push_back(zone_over(scene, 0.3, 0.4));
  Monitor monitor(scene);
  const std::array samples{sample(0, at(0, 0, 0), kStart), sample(1, at(0.3, 0, 0), kStart)};
  const Report& report = monitor.tick(samples, kStart);
  ASSERT_TRUE(report.zones[0].active);
  ZoneDifference difference(scene);
  difference.replayed(report, 41);
  std::vector<clearance_msg_ZoneState> recorded(1);
  to_wire(scene, report, 0, recorded[0]);
  recorded[0].cycle += 41;
  recorded[0].since_cycle += 41;
  EXPECT_FALSE(difference.first(recorded)) << difference.first(recorded)->what;
}

TEST(ZoneDifference, TellsTheEarliestOfAllZones) {
  Scene scene = cell_of({moving("hand", {ball(0.1)}), moving("part", {ball(0.1)})});
  for (const char* name : {"a", "b"}) {
    Zone& zone = scene.zones.emplace_back();
    zone.name = name;
    zone.pairs = {0};
  }
  std::vector<clearance_msg_ZoneState> recorded(2);
  for (const std::uint32_t zone : {0u, 1u}) {
    recorded[zone].zone = zone;
    recorded[zone].cycle = 20 - 10 * zone;
    recorded[zone].active = true;
  }
  const auto found = ZoneDifference(scene).first(recorded);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->cycle, 10u);
  EXPECT_THAT(found->what, HasSubstr("zone 'b': recorded active"));
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

// Partners publish one after the other. When the first one ends, the second one goes on, 1000 ticks
// farther.
TEST_F(OfflineReplayTest, OfTwoDaemonsInARecordingIsThatOfOneAtATime) {
  record_run(cell, run, {.ticks = 400});
  rewrite([](std::vector<Kept>& messages) {
    std::vector<Kept> both;
    std::uint64_t cycle = 0;
    const auto add = [&](const Kept& message, std::uint64_t daemon, std::uint64_t of) {
      both.push_back(altered<clearance_msg_Distances>(message, [=](auto& report) {
        report.daemon = daemon;
        report.cycle = of;
      }));
    };
    for (const Kept& message : messages) {
      if (message.kind != TopicKind::kDistances) {
        both.push_back(message);
        continue;
      }
      if (++cycle <= 200) add(message, 7, cycle);
      add(message, 8, 1000 + cycle);
    }
    messages = std::move(both);
  });
  const OfflineReplay result = replay({.compare = Comparison::kBounds});
  EXPECT_TRUE(result.ok()) << result.text();
  EXPECT_EQ(result.ticks, 301u) << "200 of the first, and those from 100 ms after it";
  EXPECT_THAT(result.notes, Contains(HasSubstr("299 reports are of a daemon that ran beside")));
  EXPECT_THAT(result.notes, Contains(HasSubstr("another one goes on, 0.299")));
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
  EXPECT_THAT(some.notes, Contains(HasSubstr("1 batch that a tick used is not in")));
  rewrite([](std::vector<Kept>& messages) {
    std::erase_if(messages, [](const Kept& m) { return m.kind == TopicKind::kPoses; });
  });
  const OfflineReplay none = replay({.compare = Comparison::kBounds});
  ASSERT_EQ(1u, none.failures.size()) << none.text();
  EXPECT_THAT(none.failures[0].what, HasSubstr("no report could be compared"));
}

}  // namespace
}  // namespace clearance::test
