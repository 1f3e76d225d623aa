#include "monitor/loop/report_queue.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance {
namespace {

Scene published_cell() {
  Scene scene =
      test::cell_of({test::moving("a", {test::ball(0.1)}), test::moving("b", {test::ball(0.1)}),
                     test::fixed("c", {test::ball(0.1)}, test::at(1, 0, 0))});
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  scene.zones.push_back(test::zone_over(scene, 0.1, 0.2));
  return scene;
}

PoseBatch batch_of(std::uint64_t sequence_number, std::size_t samples) {
  PoseBatch batch;
  batch.source = SourceName("arm");
  batch.sequence_number = sequence_number;
  batch.samples.resize(samples);
  return batch;
}

TEST(ReportQueue, CarriesReportsWithTheirSourcesInOrder) {
  const Scene scene = published_cell();
  Monitor monitor(scene);
  ReportQueue queue(scene, {.reports = 4});
  const SourceUse use{.source = SourceName("arm"), .sequence_number = 5};
  queue.report(monitor.tick({}, test::kStart), {&use, 1});
  queue.report(monitor.tick({}, test::kStart + test::kTick), {});
  ASSERT_NE(queue.reports().front(), nullptr);
  EXPECT_EQ(queue.reports().front()->report.cycle, 1u);
  EXPECT_EQ(queue.reports().front()->report.pairs.size(), 3u);
  ASSERT_EQ(queue.reports().front()->sources().size(), 1u);
  EXPECT_EQ(queue.reports().front()->sources()[0].sequence_number, 5u);
  queue.reports().pop();
  EXPECT_EQ(queue.reports().front()->report.cycle, 2u);
  EXPECT_TRUE(queue.reports().front()->sources().empty());
}

TEST(ReportQueue, CarriesTheLineageThatItWasToldLast) {
  const Scene scene = published_cell();
  Monitor monitor(scene);
  ReportQueue queue(scene, {.reports = 4});
  for (const std::uint64_t lineage : {0, 7, 8}) {
    if (lineage != 0) queue.lineage(lineage);
    queue.report(monitor.tick({}, test::kStart + static_cast<std::int64_t>(lineage)), {});
    EXPECT_EQ(queue.reports().front()->lineage, lineage);
    queue.reports().pop();
  }
}

TEST(ReportQueue, TellsTheLongestDelayOfItsReportsAndOfTheOneThatWaitsLongest) {
  const Scene scene = published_cell();
  Monitor monitor(scene);
  ReportQueue queue(scene, {.reports = 4});
  const auto report = [&](std::int64_t told_ns) {
    queue.start({.told_ns = told_ns});
    queue.report(monitor.tick({}, test::kStart + told_ns), {});
  };
  report(100);
  report(110);
  EXPECT_EQ(queue.longest_delay(1'000), TickTime::kNotMeasured) << "it has published nothing yet";
  queue.reports().pop();
  queue.published(7);
  EXPECT_EQ(queue.longest_delay(112), 7);
  EXPECT_EQ(queue.longest_delay(119), 9) << "the second report waits since 110";
  queue.reports().pop();
  queue.published(30);
  EXPECT_EQ(queue.longest_delay(150), 30);
  EXPECT_EQ(queue.longest_delay(999), TickTime::kNotMeasured) << "nothing since the last call";
  report(160);
  queue.reports().pop();
  queue.published(TickTime::kNotMeasured);
  EXPECT_EQ(queue.longest_delay(999), TickTime::kNotMeasured) << "a report that was left out";
  for (int i = 0; i < 20; ++i) {
    report(1'000 + 10 * i);
    EXPECT_EQ(queue.longest_delay(1'005 + 10 * i), 5);
    queue.reports().pop();
    queue.published(2);
  }
}

TEST(ReportQueue, DropsAndCountsWhatFindsItFull) {
  const Scene scene = published_cell();
  Monitor monitor(scene);
  ReportQueue queue(scene, {.reports = 2, .inputs = 2, .samples_a_batch = 4});
  for (int i = 0; i < 5; ++i) {
    queue.input(batch_of(1, 4));
    queue.report(monitor.tick({}, test::kStart + i), {});
  }
  EXPECT_EQ(queue.dropped_reports(), 3u);
  EXPECT_EQ(queue.dropped_inputs(), 3u);
  queue.reports().pop();
  queue.report(monitor.tick({}, test::kStart + 5), {});
  EXPECT_EQ(queue.dropped_reports(), 3u);
  EXPECT_EQ(queue.reports().front()->report.cycle, 2u);
}

TEST(ReportQueue, RefusesABatchThatIsLargerThanItsSlots) {
  const Scene scene = published_cell();
  ReportQueue queue(scene, {.inputs = 2, .samples_a_batch = 4});
  queue.input(batch_of(1, 5));
  EXPECT_EQ(queue.dropped_inputs(), 1u);
  EXPECT_EQ(queue.inputs().front(), nullptr);
}

TEST(ReportQueue, LosesNoReportThatAnAwakeConsumerExpects) {
  const Scene scene = published_cell();
  Monitor monitor(scene);
  const Report& report = monitor.tick({}, test::kStart);
  ReportQueue queue(scene, {.reports = 4, .awaits = true});
  std::atomic<int> taken{0};
  std::thread consumer([&] {
    while (!queue.closed()) {
      queue.wait();
      for (; queue.reports().front() != nullptr; ++taken) queue.reports().pop();
    }
  });
  // Some come while it is awake, others when it has just gone to sleep. After each the test waits:
  // a consumer that was not woken would never take it.
  SystemClock clock;
  constexpr int kReports = 2000;
  for (int i = 0; i < kReports && taken == i; ++i) {
    const std::int64_t now = clock.monotonic_ns();
    queue.expect(now + 10'000);
    clock.stay_awake_until(now + 100 * (i % 400));
    queue.report(report, {});
    const std::int64_t patience = clock.monotonic_ns() + 2'000'000'000;
    while (taken <= i && clock.monotonic_ns() < patience) std::this_thread::yield();
  }
  EXPECT_EQ(taken, kReports) << "the consumer was not woken";
  queue.close();
  consumer.join();
}

TEST(ReportQueue, WakesAConsumerThatExpectsAReportWhichDoesNotCome) {
  ReportQueue queue(published_cell(), {.awaits = true});
  const std::int64_t deadline = SystemClock().monotonic_ns() + 1'000'000;
  queue.expect(deadline);
  queue.wait();
  EXPECT_GE(SystemClock().monotonic_ns(), deadline) << "it stays awake until then";
  EXPECT_EQ(queue.reports().front(), nullptr);
}

TEST(ReportQueue, AllocatesNothingInTheTickThread) {
  const Scene scene = test::scara_cell();
  Monitor monitor(scene);
  ReportQueue queue(scene, {.reports = 8, .inputs = 8, .samples_a_batch = 4});
  const PoseBatch batch = batch_of(1, 4);
  const LoopStatistics statistics(scene);
  const Report& report = monitor.tick({}, test::kStart);
  const SourceUse use{};
  const std::uint64_t before = allocations();
  for (int i = 0; i < 20; ++i) {  // full slots and dropped ones
    queue.expect(0);
    queue.input(batch);
    queue.report(report, {&use, 1});
    queue.statistics(statistics);
  }
  EXPECT_EQ(allocations() - before, 0u);
}

}  // namespace
}  // namespace clearance
