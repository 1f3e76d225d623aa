#include "monitor/loop/rehearsal.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "monitor/loop/tick_loop.hpp"
#include "tests/monitor/loop/listed_ports.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance::test {
namespace {

Scene two_balls_and_a_floor() {
  Scene scene = cell_of({moving("one", {ball(0.1)}), moving("two", {ball(0.1)}),
                         fixed("floor", {floor()}, at(0, 0, -1))});
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  return scene;
}

// All figures of the pairs of every report.
class PairFigures final : public ReportSink {
 public:
  void input(const PoseBatch&) noexcept override {}
  void report(const Report& report, std::span<const SourceUse>) noexcept override {
    for (const PairReport& pair : report.pairs) {
      for (const double figure : {pair.lower, pair.upper, pair.swept_lower, pair.distance})
        all.push_back(std::bit_cast<std::uint64_t>(figure));
    }
    all.push_back(report.cycle);
  }
  void statistics(const LoopStatistics&) noexcept override {}
  std::vector<std::uint64_t> all;
};

struct LoopRun {
  std::vector<std::uint64_t> figures;
  int sleeps;
};

LoopRun run_loop(bool rehearses) {
  const Scene scene = two_balls_and_a_floor();
  TurnedClock clock;
  ListedPoses poses;
  for (std::uint64_t i = 1; i <= 20; ++i) {
    poses.add("tracker", i, 2);
    PoseBatch& batch = poses.last();
    batch.samples[1] = sample(1, at(3.0 + 0.001 * static_cast<double>(i), 0, 0), kStart);
  }
  PairFigures figures;
  figures.all.reserve(10'000);
  TickLoop loop(scene, poses, {&figures}, clock,
                {.max_ticks = 30, .max_samples = 2, .rehearses = rehearses});
  const std::atomic<bool> stop{false};
  loop.run(stop);
  return {figures.all, clock.sleeps()};
}

TEST(Rehearsal, ChangesNoReport) {
  const LoopRun plain = run_loop(false), rehearsed = run_loop(true);
  EXPECT_EQ(plain.figures, rehearsed.figures);
  EXPECT_EQ(plain.sleeps, 30);
  EXPECT_EQ(rehearsed.sleeps, 59) << "before each tick but the first";
}

TEST(Rehearsal, AllocatesNothing) {
  const Scene scene = two_balls_and_a_floor();
  const auto rehearsal = Rehearsal::of(scene);
  const std::vector<PoseSample> samples{sample(0, at(1, 0, 0), kStart),
                                        sample(1, at(2, 0, 0), kStart)};
  rehearsal->run(samples, {}, kStart);
  const auto before = allocations();
  for (int i = 0; i < 10; ++i) rehearsal->run(samples, {}, kStart + i * kTick);
  EXPECT_EQ(allocations(), before);
}

TEST(Rehearsal, IsOfOneSmallScene) {
  const Scene small = two_balls_and_a_floor(), other = two_balls_and_a_floor();
  EXPECT_TRUE(Rehearsal::of(small)->is_of(small));
  EXPECT_FALSE(Rehearsal::of(small)->is_of(other));
  const Scene large = cell_of(std::vector<Object>(64, moving("ball", {ball(0.1)})));
  ASSERT_GT(large.pairs.size(), Rehearsal::kMostPairs);
  EXPECT_EQ(Rehearsal::of(large), nullptr);
}

}  // namespace
}  // namespace clearance::test
