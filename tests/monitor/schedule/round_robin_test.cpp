// The order of evaluation if the budget does not cover all pairs: refreshes, urgent pairs,
// published pairs.
#include "monitor/schedule/scheduler.hpp"

#include <gtest/gtest.h>

#include "config/scene/refresh_share.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

// A row of balls 10 m apart, of which only the first two are close to each other.
Scene far_apart(std::uint32_t count) {
  std::vector<Object> objects{test::moving("mover", {test::ball(0.1)})};
  for (std::uint32_t i = 0; i < count; ++i) {
    objects.push_back(test::fixed("post", {test::ball(0.1)}, test::at(10.0 * i + 1.0, 0, 0)));
  }
  return test::cell_of(std::move(objects));
}

// Bodies side by side that are so long that their bounding balls prove nothing.
Scene side_by_side(std::uint32_t count) {
  std::vector<Object> objects{test::moving("mover", {test::capsule(100.0, 0.01)})};
  for (std::uint32_t i = 0; i < count; ++i) {
    objects.push_back(
        test::fixed("pole", {test::capsule(100.0, 0.01)}, test::at(0, 1.0 + 0.5 * i, 0)));
  }
  return test::cell_of(std::move(objects));
}

// Runs tick number t with the first object at this pose.
const Report& tick_with_first_at(const Pose& pose, int t, Monitor& monitor) {
  const PoseSample sample = test::sample(0, pose, kStart + t * kTick);
  return monitor.tick(std::span(&sample, 1), sample.stamp_ns);
}

TEST(Scheduler, TheRestIsEvaluatedTheStalestFirst) {
  Scene scene = side_by_side(20);
  scene.budget = 5;
  Monitor monitor(scene);
  for (int t = 0; t < 50; ++t) {
    std::vector<std::uint64_t> before;
    for (std::uint32_t p = 0; p < 20; ++p) before.push_back(monitor.pair(p).evaluated_cycle);
    const Report& report = tick_with_first_at(test::at(0, 1e-6 * t, 0), t, monitor);
    EXPECT_EQ(report.queries, 5u);
    if (t < 20) continue;
    EXPECT_LE(report.oldest_evaluation_cycles, 5u) << "19 far pairs at four or five a tick";
    std::uint64_t freshest_of_refreshed = 0, stalest_left = report.cycle;
    for (std::uint32_t p = 1; p < 20; ++p) {
      const bool refreshed = monitor.pair(p).refresh_age_cycles == 0;
      EXPECT_EQ(refreshed, monitor.pair(p).evaluated_cycle == report.cycle);
      if (refreshed) freshest_of_refreshed = std::max(freshest_of_refreshed, before[p]);
      if (!refreshed) stalest_left = std::min(stalest_left, before[p]);
    }
    EXPECT_LE(freshest_of_refreshed, stalest_left) << "tick " << t;
  }
}

// Bounding balls prove nothing here, so that only an evaluation refreshes a pair.
TEST(Scheduler, EveryPublishedPairTellsHowLongAgoItWasRefreshedAndTheReportTheLongest) {
  Scene scene = side_by_side(20);
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  scene.budget = 3;
  Monitor monitor(scene);
  std::uint64_t longest = 0;
  for (int t = 0; t < 50; ++t) {
    const Report& report = tick_with_first_at(test::at(0, 0, 0), t, monitor);
    std::uint64_t stalest = 0;
    for (const PairReport& pair : report.pairs) {
      ASSERT_EQ(pair.refresh_age_cycles, report.cycle - pair.evaluated_cycle) << "tick " << t;
      stalest = std::max(stalest, pair.refresh_age_cycles);
    }
    ASSERT_EQ(stalest, report.oldest_evaluation_cycles) << "tick " << t;
    longest = std::max(longest, stalest);
  }
  EXPECT_GE(longest, 6u) << "20 pairs, three a tick";
}

TEST(Scheduler, FarPairsAreRefreshedByTheirSpheresWithoutAQuery) {
  Scene scene = far_apart(200);
  Monitor monitor(scene);
  for (int t = 0; t < 100; ++t) {
    const Report& report = tick_with_first_at(test::at(0, 1e-6 * t, 0), t, monitor);
    EXPECT_LE(report.queries, 2u);
    EXPECT_LE(report.oldest_evaluation_cycles, 13u) << "199 pairs, 16 a tick";
  }
  EXPECT_EQ(monitor.pair(150).evaluated_cycle, 0u);
}

// No speed is stated, so that a silent object becomes unknown.
TEST(Scheduler, EveryPairIsRefreshedInTimeAlsoWhenObjectsLeaveAndComeBack) {
  std::vector<Object> objects;
  for (int i = 0; i < 40; ++i) {
    objects.push_back(test::moving("pole", {test::capsule(10.0, 0.01)}));
  }
  Scene scene = test::cell_of(std::move(objects));
  scene.refresh_s = 0.04;
  constexpr std::uint64_t kLimit = 40;
  Monitor monitor(scene);
  Random random(47);
  std::vector<int> silent(40, 0), known_for(40, 0);
  bool lost = false;
  for (int t = 0; t < 1500; ++t) {
    std::vector<PoseSample> samples;
    for (std::uint32_t i = 0; i < 40; ++i) {
      if (silent[i] == 0 && random.uniform(0, 1) < 0.002) silent[i] = 120;
      if (silent[i] > 0) --silent[i];
      if (silent[i] == 0) {
        samples.push_back(test::sample(i, test::at(0, 0.2 * i, 0), kStart + t * kTick));
      }
    }
    const Report& report = monitor.tick(samples, kStart + t * kTick);
    lost = lost || report.unknown > 0;
    for (std::uint32_t i = 0; i < 40; ++i) known_for[i] = silent[i] < 100 ? known_for[i] + 1 : 0;
    std::uint64_t stalest = 0;
    for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
      const auto& [a, b, publish] = scene.pairs[p];
      if (monitor.pair(p).status == PairStatus::kUnknown) continue;
      const std::uint64_t age = monitor.pair(p).refresh_age_cycles;
      stalest = std::max(stalest, age);
      const int known = std::min({known_for[a], known_for[b], t});
      if (known <= static_cast<int>(kLimit)) continue;
      ASSERT_LE(age, kLimit) << "tick " << t << " pair " << p;
    }
    ASSERT_LE(stalest, report.oldest_evaluation_cycles) << "tick " << t;
  }
  EXPECT_TRUE(lost);
}

// All pairs are those of one object, which is silent for longer than every pair's refresh takes.
// Four times as many as usual are then refreshed in a tick: 64 instead of 16.
TEST(Scheduler, PairsOfAnObjectThatComesBackAreRefreshedFourTimesAsFastAsUsual) {
  Scene scene = far_apart(1600);
  scene.refresh_s = 0.1;
  Monitor monitor(scene);
  int t = 0;
  for (; t < 250; ++t) tick_with_first_at(test::at(0, 0, 0), t, monitor);
  for (; t < 380; ++t) (void)monitor.tick({}, kStart + t * kTick);
  ASSERT_EQ(monitor.tick({}, kStart + t * kTick).unknown, 1600u);
  for (const int end = t + 30; t < end; ++t) tick_with_first_at(test::at(0, 0, 0), t + 1, monitor);
  EXPECT_LE(tick_with_first_at(test::at(0, 0, 0), t + 1, monitor).oldest_evaluation_cycles, 31u)
      << "1,600 pairs, 64 a tick";
}

TEST(Scheduler, FirstBinsAreEvaluatedEveryTick) {
  Scene scene = far_apart(20);
  scene.objects.push_back(test::fixed("near", {test::ball(0.1)}, test::at(11.0, 0.41, 0)));
  scene.pairs.push_back({0, 21, false});
  scene.objects[0].max_speed = 2.0;  // 2 mm per tick
  scene.budget = 2;
  Monitor monitor(scene);
  // The object is between the two posts: 5 mm from the second post, which is the minimum, and 5
  // ticks from the near one.
  for (int t = 0; t < 30; ++t) {
    const Report& report = tick_with_first_at(test::at(11.0, 0.205 - 0.005, 0), t, monitor);
    EXPECT_EQ(report.minimum.pair, 1u);
    EXPECT_EQ(report.minimum.evaluated_cycle, report.cycle);
    EXPECT_EQ(monitor.pair(20).evaluated_cycle, report.cycle);
  }
}

TEST(Scheduler, WhatIsNotProvedOutsideAZoneComesBeforeTheRest) {
  Scene scene = far_apart(20);
  scene.zones = {test::zone_over(scene, 25.0, 25.0)};  // the first three posts are within the zone
  scene.budget = 4;
  Monitor monitor(scene);
  for (int t = 0; t < 50; ++t) {
    const Report& report = tick_with_first_at(test::at(0, 1e-4 * t, 0), t, monitor);
    EXPECT_TRUE(report.zones[0].active);
    EXPECT_TRUE(report.zones[0].certified);
  }
}

TEST(Scheduler, SaysWhenTheBudgetEndsBeforeAZoneIsProved) {
  Scene scene = far_apart(20);
  scene.zones = {test::zone_over(scene, 1000.0, 1000.0)};
  scene.budget = 4;
  Monitor monitor(scene);
  EXPECT_FALSE(tick_with_first_at(test::at(0, 0, 0), 0, monitor).zones[0].certified);
}

TEST(Scheduler, PublishedPairsBeyondTheBudgetDoNotStarveTheRest) {
  Scene scene = far_apart(20);
  for (std::size_t p = 0; p < 15; ++p) scene.pairs[p].publish = true;
  scene.budget = 4;
  Monitor monitor(scene);
  std::uint64_t oldest = 0;
  for (int t = 0; t < 50; ++t) {
    const Report& report = tick_with_first_at(test::at(0, 1e-6 * t, 0), t, monitor);
    if (t >= 20) oldest = std::max(oldest, report.oldest_evaluation_cycles);
  }
  EXPECT_LE(oldest, 7u);
}

// A hundred published pairs are due in every tick, and pairs that are awake take the rest of the
// budget.
TEST(Scheduler, PublishedPairsThatAreAllEvaluatedLeaveTheOthersTheirRefresh) {
  Scene scene = side_by_side(150);
  for (std::size_t p = 0; p < 100; ++p) scene.pairs[p].publish = true;
  scene.refresh_s = 0.05;
  scene.zones = {test::zone_over(scene, 1000.0, 1000.0)};
  scene.budget = 103;
  ASSERT_LE(refresh_share(scene).queries(), scene.budget);
  Monitor monitor(scene);
  for (int t = 0; t < 300; ++t) {
    const Report& report = tick_with_first_at(test::at(0, 1e-4 * t, 0), t, monitor);
    if (t > 100) {
      ASSERT_LE(report.oldest_evaluation_cycles, 50u) << "tick " << t;
    }
  }
}

// Pairs in a zone want more in every tick than the refresh leaves of the budget. The others get
// their share all the same. In the last case, all but a few need it, so that the published pairs
// must have a share of their own.
TEST(Scheduler, UrgentPairsLeaveTheOthersTheirRefresh) {
  struct Case {
    std::uint32_t pairs;
    std::size_t in_zone, published;
  };
  for (const auto& [pairs, in_zone, published] :
       {Case{150, 20, 0}, Case{150, 20, 8}, Case{420, 5, 6}}) {
    Scene scene = side_by_side(pairs);
    Zone zone = test::zone_over(scene, 1000.0, 1000.0);
    zone.pairs.resize(in_zone);
    scene.zones = {zone};
    for (std::size_t p = in_zone; p < in_zone + published; ++p) scene.pairs[p].publish = true;
    scene.refresh_s = 0.05;
    scene.budget = 10;
    ASSERT_LE(refresh_share(scene).queries(), scene.budget);
    Monitor monitor(scene);
    for (int t = 0; t < 300; ++t) {
      const Report& report = tick_with_first_at(test::at(0, 1e-4 * t, 0), t, monitor);
      if (t > 100) {
        ASSERT_LE(report.oldest_evaluation_cycles, 50u) << published << ", tick " << t;
      }
    }
  }
}

TEST(Scheduler, PublishedPairsAreEvaluatedAfterWhatIsUrgentWhenTheBudgetDoesNotCoverBoth) {
  Scene scene = far_apart(20);
  for (std::size_t p = 10; p < 14; ++p) scene.pairs[p].publish = true;
  scene.zones = {test::zone_over(scene, 25.0, 25.0)};  // the first three posts are within the zone
  scene.budget = 6;
  Monitor monitor(scene);
  for (int t = 0; t < 30; ++t) {
    const Report& report = tick_with_first_at(test::at(0, 1e-4 * t, 0), t, monitor);
    EXPECT_EQ(report.queries, 6u);
    EXPECT_TRUE(report.minimum_certified);
    EXPECT_TRUE(report.zones[0].certified);
  }
}

TEST(Scheduler, PublishedPairsComeBeforeTheRest) {
  Scene scene = far_apart(20);
  scene.pairs[17].publish = true;
  scene.budget = 3;
  Monitor monitor(scene);
  for (int t = 0; t < 30; ++t) {
    const Report& report = tick_with_first_at(test::at(0, 1e-5 * t, 0), t, monitor);
    ASSERT_EQ(report.pairs.size(), 1u);
    EXPECT_EQ(report.pairs[0].pair, 17u);
    EXPECT_EQ(report.pairs[0].evaluated_cycle, report.cycle);
  }
}

}  // namespace
}  // namespace clearance
