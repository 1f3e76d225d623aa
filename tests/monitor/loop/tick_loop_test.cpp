// The fixed-rate loop through its ports: a list of batches, a clock that the test moves, and a list
// of reports.
#include "monitor/loop/tick_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "monitor/tick/self_test.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tests/monitor/loop/listed_ports.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;
using test::ListedPoses;
using test::ListedReports;
using test::TurnedClock;

Scene ball_over_floor() {
  Scene scene = test::cell_of({test::moving("ball", {test::ball(0.1)}),
                               test::fixed("floor", {test::floor()}, test::at(0, 0, -1))});
  scene.pairs[0].publish = true;
  return scene;
}

struct Loop {
  Scene scene = ball_over_floor();
  TurnedClock clock;
  ListedPoses poses;
  ListedReports reports{clock};
  std::atomic<bool> stop{false};

  void run(const TickLoopOptions& options) {
    TickLoop loop(scene, poses, {&reports}, clock, options);
    loop.run(stop);
    statistics = loop.statistics();
  }
  LoopStatistics statistics;
};

TEST(TickLoop, TakesJointsInBesidePoses) {
  Loop loop;
  loop.scene = test::scara_cell();
  loop.poses.add("arm", 1, test::joints(0.1, 0.2, 0.1, kStart));
  loop.poses.add("arm", 2, test::joints(0.1, 0.2, 0.1, kStart));
  loop.poses.add("cart", 1, 1);
  loop.run({.max_ticks = 2, .max_samples = 5});
  // The second batch does not fit into the first tick, so the following ones wait as well.
  EXPECT_EQ(loop.reports.inputs_before, (std::vector<std::size_t>{1, 3}));
  for (const std::uint32_t link : {3, 4, 5}) EXPECT_GE(loop.statistics.ages[link].age_ns, 0);
  EXPECT_TRUE(loop.statistics.minimum.known);
}

TEST(TickLoop, EndsBeforeItHandsOverAReportOfATickWhoseSelfTestHasFailed) {
  Loop loop;
  double& margin = loop.scene.objects[0].margin;
  loop.clock.while_asleep = [&](int tick) {
    if (tick == 3) margin = std::nextafter(margin, 1.0);
  };
  TickLoop ticks(loop.scene, loop.poses, {&loop.reports}, loop.clock, {.max_ticks = 1000});
  const std::uint64_t within = ticks.state().monitor().self_test().ticks();
  ticks.run(loop.stop);
  EXPECT_EQ(ticks.state().monitor().self_test().fault(),
            "the table 'objects' of the scene has changed in memory");
  EXPECT_EQ(loop.reports.cycles.size() + 1, ticks.state().cycle());
  EXPECT_LE(ticks.state().cycle(), 2 + within);
  EXPECT_EQ(loop.reports.all_statistics.size(), 1u) << "the last figures are told";
}

TEST(TickLoop, TicksOnItsDeadlines) {
  Loop loop;
  loop.run({.max_ticks = 5});
  EXPECT_EQ(loop.reports.cycles, (std::vector<std::uint64_t>{1, 2, 3, 4, 5}));
  EXPECT_EQ(loop.reports.times_ns,
            (std::vector<std::int64_t>{kTick, 2 * kTick, 3 * kTick, 4 * kTick, 5 * kTick}));
  EXPECT_EQ(loop.statistics.overruns, 0u);
  EXPECT_EQ(loop.statistics.skipped_cycles, 0u);
}

TEST(TickLoop, StartsTheNextTickAtOnceAfterAShortOverrun) {
  Loop loop;
  loop.reports.slow_cycle = 2;
  loop.reports.slow_ns = kTick + kTick / 4;
  loop.run({.max_ticks = 4});
  EXPECT_EQ(loop.statistics.overruns, 1u);
  EXPECT_EQ(loop.statistics.skipped_cycles, 0u);
  EXPECT_EQ(loop.reports.times_ns,
            (std::vector<std::int64_t>{kTick, 2 * kTick, 3 * kTick + kTick / 4, 4 * kTick}));
}

TEST(TickLoop, SkipsMissedDeadlinesAndIsBackOnItsGridWithoutAGapInTheCycles) {
  Loop loop;
  loop.reports.slow_cycle = 2;
  loop.reports.slow_ns =
      5 * kTick + kTick / 2;  // from 2 to 7.5: deadlines 3 to 6 have passed, 7 is late
  loop.run({.max_ticks = 5});
  EXPECT_EQ(loop.statistics.overruns, 1u);
  EXPECT_EQ(loop.statistics.skipped_cycles, 4u);
  EXPECT_EQ(loop.reports.cycles, (std::vector<std::uint64_t>{1, 2, 3, 4, 5}));
  EXPECT_EQ(
      loop.reports.times_ns,
      (std::vector<std::int64_t>{kTick, 2 * kTick, 7 * kTick + kTick / 2, 8 * kTick, 9 * kTick}));
}

TEST(TickLoop, RestsAboutEvery50MillisecondsWhenNoTickIsInTime) {
  Loop loop;
  loop.reports.all_slow = true;
  loop.reports.slow_ns = kTick + kTick / 4;
  loop.run({.max_ticks = 400});
  EXPECT_EQ(loop.statistics.overruns, 400u);
  const std::int64_t lasted_ns = loop.clock.monotonic_ns();
  EXPECT_GE(loop.clock.rests(), lasted_ns / 55'000'000);
  EXPECT_LE(loop.clock.rests(), lasted_ns / 45'000'000);
}

TEST(TickLoop, RestsAlsoWhenAllTicksEndWhenTheNextOneIsToBePrepared) {
  Loop loop;
  loop.reports.all_slow = true;
  loop.reports.slow_ns = kTick - 20'000;
  loop.run({.max_ticks = 400, .ahead_ns = 50'000});
  EXPECT_EQ(loop.statistics.overruns, 0u);
  EXPECT_GE(loop.clock.rests(), 400 * kTick / 55'000'000);
}

// Copies reports, and checks what it was told to expect.
class ExpectingSink final : public ReportSink {
 public:
  explicit ExpectingSink(TurnedClock& clock) : clock_(clock) {}
  void expect(std::int64_t deadline_ns) noexcept override {
    told_ns.push_back(clock_.monotonic_ns());
    deadlines_ns.push_back(deadline_ns);
  }
  void input(const PoseBatch&) noexcept override {}
  void report(const Report& report, std::span<const SourceUse>) noexcept override {
    checksums.push_back(checksum_of_rest(report, 0));
    times_ns.push_back(report.now_ns);
    pairs.push_back(report.pairs);
  }
  void statistics(const LoopStatistics&) noexcept override {}
  std::vector<std::int64_t> told_ns, deadlines_ns, times_ns;
  std::vector<std::uint64_t> checksums;
  std::vector<std::vector<PairReport>> pairs;

 private:
  TurnedClock& clock_;
};

TEST(TickLoop, ChangesNoBitOfAReportByWakingAhead) {
  const auto run = [](std::int64_t ahead_ns) {
    Loop loop;
    for (std::uint64_t i = 1; i <= 30; ++i) {
      loop.poses.add("arm", i, 1);
      loop.poses.last().samples[0].world_from_object.position.z() += 0.001 * static_cast<double>(i);
      loop.poses.last().samples[0].stamp_ns += static_cast<std::int64_t>(i) * kTick;
    }
    ExpectingSink sink(loop.clock);
    TickLoop(loop.scene, loop.poses, {&sink}, loop.clock,
             {.max_ticks = 50, .max_samples = 1, .ahead_ns = ahead_ns})
        .run(loop.stop);
    return sink;
  };
  const ExpectingSink at_deadlines = run(0), ahead = run(30'000);
  EXPECT_TRUE(at_deadlines.told_ns.empty());
  ASSERT_EQ(ahead.told_ns.size(), 50u);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(ahead.deadlines_ns[i], static_cast<std::int64_t>(i + 1) * kTick);
    EXPECT_EQ(ahead.told_ns[i], ahead.deadlines_ns[i] - 30'000);
    ASSERT_EQ(ahead.pairs[i].size(), 1u);
    const PairReport &a = at_deadlines.pairs[i][0], &b = ahead.pairs[i][0];
    EXPECT_EQ(a.lower, b.lower);
    EXPECT_EQ(a.upper, b.upper);
    EXPECT_EQ(a.swept_lower, b.swept_lower);
  }
  EXPECT_EQ(ahead.times_ns, at_deadlines.times_ns);
  EXPECT_EQ(ahead.checksums, at_deadlines.checksums);
  EXPECT_NE(ahead.pairs[10][0].lower, ahead.pairs[20][0].lower) << "the ball moves";
}

TEST(TickLoop, CountsHowLateItWakesAndHowLongTicksTake) {
  Loop loop;
  loop.clock.wake_late_by(20'000);
  loop.reports.slow_cycle = 3;
  loop.reports.slow_ns = 400'000;
  loop.run({.max_ticks = 10});
  EXPECT_EQ(loop.statistics.wakeup.count(), 10u);
  EXPECT_EQ(loop.statistics.wakeup.max_ns(), 20'000);
  EXPECT_EQ(loop.statistics.tick.max_ns(), 400'000);
  EXPECT_EQ(loop.statistics.tick_second_max_ns, 0) << "begins again once it was handed over";
  EXPECT_EQ(loop.reports.all_statistics.back().tick_second_max_ns, 400'000);
  EXPECT_EQ(loop.statistics.wakeup_second_max_ns, 0);
  EXPECT_EQ(loop.reports.all_statistics.back().wakeup_second_max_ns, 20'000);
}

TEST(TickLoop, HandsVitalsOverOnceASecondAndAtTheEnd) {
  Loop loop;
  loop.scene.rate_hz = 10.0;
  loop.run({.max_ticks = 25});
  ASSERT_EQ(loop.reports.all_statistics.size(), 3u);
  EXPECT_EQ(loop.reports.all_statistics[0].cycle, 10u);
  EXPECT_EQ(loop.reports.all_statistics[1].cycle, 20u);
  EXPECT_EQ(loop.reports.all_statistics[2].cycle, 25u);
}

TEST(TickLoop, TakesInAllThatWaitsInOrderAndNamesTheLastOfEachSource) {
  Loop loop;
  loop.poses.add("left", 7, 1);
  loop.poses.add("right", 1, 1);
  loop.poses.add("left", 8, 1);
  loop.run({.max_ticks = 2});
  EXPECT_EQ(loop.reports.inputs, (std::vector<std::uint64_t>{7, 1, 8}));
  EXPECT_EQ(loop.reports.inputs_before, (std::vector<std::size_t>{3, 3}));
  ASSERT_EQ(loop.reports.used[0].size(), 2u);
  EXPECT_EQ(loop.reports.used[0][0].source.view(), "left");
  EXPECT_EQ(loop.reports.used[0][0].sequence_number, 8u);
  EXPECT_EQ(loop.reports.used[0][1].source.view(), "right");
  EXPECT_EQ(loop.reports.used[0][1].sequence_number, 1u);
  EXPECT_TRUE(loop.reports.used[1].empty());
}

TEST(TickLoop, LeavesWhatDoesNotFitForTheNextTick) {
  Loop loop;
  for (std::uint64_t i = 1; i <= 4; ++i) loop.poses.add("arm", i, 3);
  loop.run({.max_ticks = 3, .max_samples = 7});
  EXPECT_EQ(loop.reports.inputs_before, (std::vector<std::size_t>{2, 4, 4}));
  EXPECT_EQ(loop.reports.inputs, (std::vector<std::uint64_t>{1, 2, 3, 4}));
}

TEST(TickLoop, TakesInABatchThatFitsExactly) {
  Loop loop;
  loop.poses.add("arm", 1, 3);
  loop.poses.add("arm", 2, 4);
  loop.poses.add("arm", 3, 1);
  loop.run({.max_ticks = 2, .max_samples = 7});
  EXPECT_EQ(loop.reports.inputs_before, (std::vector<std::size_t>{2, 3}));
}

TEST(TickLoop, RefusesBatchesMadeForAnotherSceneAndCountsThem) {
  Loop loop;
  loop.poses.add("arm", 1, 2, loop.scene.revision + 1);
  loop.poses.add("arm", 2, 1, loop.scene.revision);
  loop.run({.max_ticks = 2});
  const auto cause = static_cast<std::size_t>(Reject::kWrongRevision);
  EXPECT_EQ(loop.reports.rejected[cause], 2u);
  EXPECT_EQ(loop.statistics.rejected[0][cause], 2u);
  EXPECT_EQ(loop.reports.used[0].at(0).sequence_number, 2u);
}

// A recording has the names of joints instead of their ids, so that a replay would use them.
TEST(TickLoop, NamesAndRecordsNoJointsWithIdsOfAnUnknownScene) {
  Loop loop;
  loop.scene = test::scara_cell();
  loop.poses.add("arm", 1, test::joints(0.1, 0.2, 0.1, kStart));
  loop.poses.last().scene_revision = loop.scene.revision + 1;
  loop.poses.add("arm", 2, test::joints(0.1, 0.2, 0.1, kStart));
  loop.poses.last().scene_revision = loop.scene.revision + 1;
  loop.poses.add("other", 3, test::joints(0.1, 0.2, 0.1, kStart));
  loop.poses.last().scene_revision = loop.scene.revision;
  loop.run({.max_ticks = 1});
  EXPECT_EQ(loop.reports.inputs, std::vector<std::uint64_t>{3});
  ASSERT_EQ(loop.reports.used[0].size(), 1u);
  EXPECT_EQ(loop.reports.used[0][0].source.view(), "other");
}

TEST(TickLoop, RemembersTheSmallestDistanceSeen) {
  Loop loop;
  loop.poses.add("arm", 1, 1);
  loop.run({.max_ticks = 3});
  ASSERT_TRUE(loop.statistics.minimum.known);
  EXPECT_EQ(loop.statistics.minimum.cycle, 1u);
  EXPECT_NEAR(loop.statistics.minimum.pair.distance, 0.9, 1e-12);
}

TEST(TickLoop, StopsWhenTold) {
  Loop loop;
  loop.stop = true;
  loop.run({});
  EXPECT_TRUE(loop.reports.cycles.empty());
  EXPECT_EQ(loop.clock.sleeps(), 0);
}

// A sink that only counts the allocations of a tick.
class CountingSink final : public ReportSink {
 public:
  void input(const PoseBatch&) noexcept override {}
  void report(const Report& report, std::span<const SourceUse>) noexcept override {
    if (report.cycle == 1) first_ = allocations();
    last_ = allocations();
  }
  void statistics(const LoopStatistics&) noexcept override {}
  [[nodiscard]] std::uint64_t allocated() const noexcept { return last_ - first_; }

 private:
  std::uint64_t first_ = 0, last_ = 0;
};

TEST(TickLoop, AllocatesNothingOnceItRuns) {
  Loop loop;
  loop.scene.rate_hz = 10.0;  // so that statistics are handed over during the run
  for (std::uint64_t i = 1; i <= 300; ++i) loop.poses.add("arm", i, 3);
  CountingSink sink;
  TickLoop ticking(loop.scene, loop.poses, {&sink}, loop.clock,
                   {.max_ticks = 200, .max_samples = 8, .ahead_ns = 50'000});
  ticking.run(loop.stop);
  EXPECT_EQ(sink.allocated(), 0u);
}

}  // namespace
}  // namespace clearance
