// The loop changes from the monitor of one scene to that of another between two ticks.
#include "monitor/tick/successor.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <list>
#include <memory>
#include <numeric>
#include <thread>

#include "monitor/loop/tick_loop.hpp"
#include "tests/monitor/loop/listed_ports.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;
using State = Successor::State;

// Balls of radius 0.1, one above the other by name. All pairs are published.
Scene balls(const std::vector<std::string>& names, std::uint64_t revision) {
  std::vector<Object> objects;
  for (const std::string& name : names) objects.push_back(test::moving(name, {test::ball(0.1)}));
  Scene scene = test::cell_of(std::move(objects));
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  scene.revision = revision;
  return scene;
}

// Keeps what the reports said.
class Kept final : public ReportSink {
 public:
  Kept() { cycles.reserve(10'000), revisions.reserve(10'000), distances.reserve(10'000); }
  void input(const PoseBatch&) noexcept override {}
  void report(const Report& report, std::span<const SourceUse>) noexcept override {
    cycles.push_back(report.cycle);
    revisions.push_back(report.scene_revision);
    distances.push_back(report.minimum_known ? report.minimum.distance : -1.0);
    unknown = report.unknown;
    rejected = report.rejected;
  }
  void statistics(const LoopStatistics& statistics) noexcept override { last = statistics; }

  std::vector<std::uint64_t> cycles, revisions;
  std::vector<double> distances;
  std::uint32_t unknown = 0;
  std::array<std::uint64_t, kRejects> rejected{};
  LoopStatistics last;
};

class Succession : public testing::Test {
 protected:
  // Poses of the first scene's objects, a batch a tick, with this revision.
  void poses_for(int ticks, std::uint64_t revision, std::vector<double> places) {
    for (int i = 0; i < ticks; ++i) {
      PoseBatch batch;
      batch.source = SourceName("arm");
      batch.sequence_number = ++number;
      batch.scene_revision = revision;
      for (std::uint32_t object = 0; object < places.size(); ++object) {
        batch.samples.push_back(test::sample(object, test::at(places[object], 0, 0),
                                             kStart + static_cast<std::int64_t>(number) * kTick));
      }
      batches.push_back(std::move(batch));
    }
  }
  void run(std::uint64_t ticks) {
    loop = std::make_unique<TickLoop>(first, poses, std::vector<ReportSink*>{&before}, clock,
                                      TickLoopOptions{.max_ticks = ticks});
    std::atomic<bool> stop{false};
    loop->run(stop);
  }
  SceneOffer& succeed(const Scene& scene, const TickRecords::Room& room = {}) {
    return successors.emplace_back(loop->state(), scene, std::vector<ReportSink*>{&after},
                                   records.emplace_back(room));
  }

  // Offers the scene before tick 5 and lets it catch up before each tick from then on.
  void change_to(const Scene& scene) {
    clock.while_asleep = [this, &scene](int tick) {
      if (tick == 5) {
        EXPECT_TRUE(loop->offer(succeed(scene)));
        allocated = allocations();
      }
      if (tick >= 5) successors.front().catch_up();
      if (tick < 20) allocated_later = allocations();
    };
  }

  // A batch a tick.
  class Poses final : public PoseSource {
   public:
    explicit Poses(Succession& test) : test_(test) {}
    const PoseBatch* next() noexcept override {
      const auto due = static_cast<std::size_t>(test_.clock.sleeps());
      return given_ < std::min(due, test_.batches.size()) ? &test_.batches[given_++] : nullptr;
    }

   private:
    Succession& test_;
    std::size_t given_ = 0;
  };

  Scene first = balls({"a", "b"}, 7);
  test::TurnedClock clock;
  std::vector<PoseBatch> batches;
  Poses poses{*this};
  Kept before, after;
  std::uint64_t number = 0;
  std::uint64_t allocated = 0, allocated_later = 0;  // before tick 5 and tick 19
  std::unique_ptr<TickLoop> loop;
  std::list<TickRecords> records;
  std::list<SceneOffer> successors;
};

TEST_F(Succession, TheNextTickButOneIsThatOfTheChangedSceneAndNoneIsMissing) {
  const Scene second = balls({"b", "c", "a"}, 8);
  poses_for(20, 7, {0.0, 1.0});
  change_to(second);
  run(10);
  EXPECT_EQ(successors.front().state(), State::kSucceeded);
  EXPECT_EQ(successors.front().began_after(), 4u);
  EXPECT_EQ(successors.front().in_force_from(), 6u);
  EXPECT_EQ(before.cycles, (std::vector<std::uint64_t>{1, 2, 3, 4, 5}));
  EXPECT_EQ(after.cycles, (std::vector<std::uint64_t>{6, 7, 8, 9, 10}));
  EXPECT_EQ(after.revisions, std::vector<std::uint64_t>(5, 8));
  for (const double distance : after.distances) EXPECT_NEAR(distance, 0.8, 1e-12);
  EXPECT_EQ(after.unknown, 2u) << "pairs of c";
  EXPECT_EQ(after.last.cycle, 10u);
  EXPECT_EQ(after.last.ages.size(), 3u);
}

TEST_F(Succession, BatchesForFormerScenesArePassedOnAndThoseOfOthersRefused) {
  const Scene second = balls({"b", "a"}, 8), third = balls({"c", "b", "a"}, 9);
  poses_for(25, 7, {0.0, 1.0});
  poses_for(10, 8, {2.0, 0.5});
  poses_for(5, 6, {0.0, 1.0});
  std::vector<std::uint32_t> unknown;
  clock.while_asleep = [&](int tick) {
    if (tick == 5) {
      EXPECT_TRUE(loop->offer(succeed(second)));
    }
    if (tick == 15) {
      EXPECT_TRUE(loop->offer(successors.emplace_back(
          loop->state(), third, std::vector<ReportSink*>{&after}, records.emplace_back())));
    }
    if (tick >= 5) successors.back().catch_up();
  };
  run(40);
  ASSERT_EQ(after.cycles.size(), 35u);
  EXPECT_EQ(after.revisions[5], 8u);
  EXPECT_EQ(after.revisions[15], 9u);
  for (int i = 0; i < 20; ++i) EXPECT_NEAR(after.distances[i], 0.8, 1e-12) << i;
  for (int i = 20; i < 30; ++i) EXPECT_NEAR(after.distances[i], 1.3, 1e-12) << i;
  EXPECT_EQ(after.rejected[static_cast<std::size_t>(Reject::kWrongRevision)], 2u * 5u);
}

TEST_F(Succession, BatchesThatStateNoRevisionAreRefusedAfterAChange) {
  const Scene second = balls({"b", "a"}, 8);
  poses_for(100, 0, {0.0, 1.0});
  change_to(second);
  run(10);
  EXPECT_EQ(after.rejected[static_cast<std::size_t>(Reject::kWrongRevision)], 2u * 5u);
}

TEST_F(Succession, ASuccessorThatDoesNotCatchUpIsDroppedAndTheNextOneTried) {
  const Scene second = balls({"b", "a"}, 8);
  poses_for(100, 7, {0.0, 1.0});
  clock.while_asleep = [&](int tick) {
    if (tick == 5) {
      EXPECT_TRUE(loop->offer(succeed(second, {.ticks = 4, .poses = 64, .joints = 64})));
      EXPECT_FALSE(loop->offer(successors.front())) << "one at a time";
    }
    if (tick == 20) {
      EXPECT_EQ(successors.front().state(), State::kTooSlow);
      EXPECT_EQ(successors.front().catch_up(), 0u);
      EXPECT_TRUE(loop->offer(succeed(second)));
    }
    if (tick >= 20) successors.back().catch_up();
  };
  run(30);
  EXPECT_EQ(before.cycles.size(), 20u);
  EXPECT_EQ(after.cycles.size(), 10u);
}

TEST_F(Succession, ASceneThatNamesTooManySourcesBesideTheRunningOneIsRefused) {
  first.objects[0].source = "first";
  Scene second = balls({"a", "b"}, 8);
  for (std::size_t i = 0; i < kMaxSources; ++i) {
    second.objects.push_back(test::moving("n" + std::to_string(i), {test::ball(0.1)}));
    second.objects.back().source = "s" + std::to_string(i);
  }
  change_to(second);
  run(10);
  EXPECT_EQ(successors.front().state(), State::kTooManyNames);
  EXPECT_TRUE(successors.front().failed());
  EXPECT_EQ(before.cycles.size(), 10u);
}

TEST_F(Succession, AChangeAllocatesNothingInTheTickThread) {
  const Scene second = balls({"b", "c", "a"}, 8);
  poses_for(50, 7, {0.0, 1.0});
  change_to(second);
  run(20);
  EXPECT_EQ(after.cycles.size(), 15u);
  EXPECT_EQ(allocated_later, allocated);
}

// Two threads, and as many changes as they can make.
TEST(SuccessionOfThreads, EveryCycleIsReportedOnceWhileScenesChange) {
  const Scene scenes[] = {balls({"a", "b"}, 7), balls({"c", "b", "a"}, 8)};
  class NoPoses final : public PoseSource {
    const PoseBatch* next() noexcept override { return nullptr; }
  } poses;
  SystemClock clock;
  Kept sinks[2];
  TickLoop loop(scenes[0], poses, {&sinks[0]}, clock);
  std::atomic<bool> stop{false};
  std::thread ticking([&] { loop.run(stop); });
  TickRecords records;
  std::unique_ptr<SceneOffer> last;
  constexpr int kChanges = 40;
  for (int change = 1; change <= kChanges; ++change) {
    auto next = std::make_unique<SceneOffer>(loop.state(), scenes[change % 2],
                                             std::vector<ReportSink*>{&sinks[change % 2]}, records);
    ASSERT_TRUE(loop.offer(*next));
    while (next->state() != State::kSucceeded) {
      next->catch_up();
      ASSERT_FALSE(next->failed());
      std::this_thread::yield();
    }
    while (loop.busy()) std::this_thread::yield();
    last = std::move(next);
  }
  stop = true;
  ticking.join();
  std::vector<std::uint64_t> cycles;
  for (const Kept& sink : sinks)
    cycles.insert(cycles.end(), sink.cycles.begin(), sink.cycles.end());
  std::ranges::sort(cycles);
  std::vector<std::uint64_t> all(cycles.size());
  std::iota(all.begin(), all.end(), 1u);
  EXPECT_EQ(cycles, all);
  EXPECT_GE(cycles.size(), 2u * kChanges);
  for (int i = 0; i < 2; ++i) {
    for (const std::uint64_t revision : sinks[i].revisions) ASSERT_EQ(revision, scenes[i].revision);
  }
}

// The thread that sends a successor's state reads its lineage as soon as it sees that it has begun.
TEST(SuccessionOfThreads, ThePaceKnowsOfASuccessorBeforeOtherThreadsSeeThatItHasBegun) {
  const Scene scene = balls({"a", "b"}, 7);
  class NoPoses final : public PoseSource {
    const PoseBatch* next() noexcept override { return nullptr; }
  } poses;
  class Pace final : public TickPace {
   public:
    std::atomic<const Successor*> successor{nullptr};
    std::atomic<bool> has_begun_before{false};

   private:
    std::int64_t ahead_ns() const noexcept override { return 0; }
    std::int64_t decide(std::int64_t deadline, std::uint64_t, std::uint64_t) noexcept override {
      return deadline;
    }
    TickTime time() noexcept override { return now_ns_ += kTick; }
    void ticked(const Monitor&) noexcept override {}
    std::uint64_t lineage() const noexcept override { return 1; }
    bool is_behind() noexcept override { return false; }
    void successor_begins(bool) noexcept override {
      has_begun_before = successor.load()->state() != State::kOffered;
    }
    void successor_gave_up() noexcept override {}
    void successor_followed() noexcept override {}
    bool may_join() const noexcept override { return false; }
    void joined(std::uint64_t, std::uint64_t) noexcept override {}
    std::int64_t now_ns_ = 1;
  } pace;
  SystemClock clock;
  Kept sinks[2];
  TickLoop loop(scene, poses, {&sinks[0]}, clock, {.pace = &pace});
  TickRecords records;
  SceneOffer next(loop.state(), scene, {&sinks[1]}, records);
  pace.successor = &next;
  ASSERT_TRUE(loop.offer(next));
  std::atomic<bool> stop{false};
  std::thread ticking([&] { loop.run(stop); });
  while (next.state() == State::kOffered) std::this_thread::yield();
  EXPECT_FALSE(pace.has_begun_before);
  while (next.state() != State::kSucceeded && !next.failed()) {
    next.catch_up();
    std::this_thread::yield();
  }
  stop = true;
  ticking.join();
}

// The running report is certified, and that of the changed scene cannot be: c has been silent for
// too long, or b is not there.
TEST_F(Succession, WaitsForNoInputThatIsMissing) {
  Scene three = balls({"a", "b", "c"}, 7);
  for (Object& object : three.objects) object.max_speed = 1.0;
  first = three;
  first.pairs = {three.pairs[0]};
  Scene late = three, absent = balls({"a", "b"}, 8);
  late.revision = 8;
  absent.objects[1].absent = true;
  poses_for(1, 7, {0.0, 1.0, 2.0});
  poses_for(60, 7, {0.0, 1.0});
  for (const Scene& second : {late, absent}) {
    successors.clear();
    clock.while_asleep = [this, &second, start = clock.sleeps()](int tick) {
      if (tick == start + 30) {
        EXPECT_TRUE(loop->offer(succeed(second)));
      }
      if (tick >= start + 30) successors.front().catch_up();
    };
    run(40);
    ASSERT_EQ(successors.front().state(), State::kSucceeded);
    EXPECT_EQ(successors.front().in_force_from(), successors.front().began_after() + 2);
    loop.reset();
  }
}

// With one query a tick, three pairs that move together are never certified.
TEST_F(Succession, WaitsNoLongerThanStatedForABudgetThatIsTooSmall) {
  Scene second = balls({"a", "b", "c"}, 8);
  second.budget = 1;
  first = balls({"a", "b", "c"}, 7);
  poses_for(400, 7, {0.0, 0.3, 0.6});
  for (std::size_t i = 0; i < batches.size(); ++i) {
    for (PoseSample& sample : batches[i].samples)
      sample.world_from_object.position.y() = 0.1 * static_cast<double>(i);
  }
  change_to(second);
  run(400);
  ASSERT_EQ(successors.front().state(), State::kSucceeded);
  EXPECT_GT(successors.front().in_force_from(), Successor::kMostUncertified);
  EXPECT_LE(successors.front().in_force_from(), 6 + 1 + Successor::kMostUncertified);
}

}  // namespace
}  // namespace clearance
