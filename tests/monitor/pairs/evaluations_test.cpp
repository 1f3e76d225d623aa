// Records of evaluations that part pairs share, alone and in a monitor of more pairs than records.
// The oracle of the monitor is a cold query of every pair.
#include "monitor/pairs/evaluations.hpp"

#include <gtest/gtest.h>

#include "tests/monitor/tick/fresh_distance.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance::test {
namespace {

constexpr std::uint32_t kSharedRecords = Evaluations::kShared;

void query_in_cycle(std::uint32_t part_pair, std::uint64_t cycle, Evaluations& evaluations) {
  evaluations.of_query(part_pair, cycle).gap = part_pair;
  evaluations.set_cycle(part_pair, cycle);
}

TEST(Evaluations, APartPairThatLosesItsRecordCountsAsNeverEvaluated) {
  Evaluations evaluations(kSharedRecords + 10, 5);
  evaluations.share();
  for (std::uint32_t i = 0; i <= kSharedRecords; ++i) query_in_cycle(i, 1 + i / 100, evaluations);
  EXPECT_EQ(evaluations.cycle(0), 0u);
  EXPECT_EQ(evaluations[0].gap, -kInfinity);
  EXPECT_TRUE(std::isnan(evaluations[0].closest.distance));
  EXPECT_EQ(evaluations.find(0), nullptr);
  EXPECT_EQ(evaluations.of_query(kSharedRecords + 5, 1'000).gap, -kInfinity)
      << "a record of its own";
  for (std::uint32_t i = 2; i <= kSharedRecords; ++i) ASSERT_EQ(evaluations[i].gap, i);
}

TEST(Evaluations, NoRecordOfThisTickIsTaken) {
  Evaluations evaluations(3 * kSharedRecords, 5);
  evaluations.share();
  for (std::uint32_t i = 0; i < kSharedRecords; ++i) query_in_cycle(i, 1, evaluations);
  for (const std::uint32_t i : {0u, 1u, 3u}) query_in_cycle(i, 2, evaluations);
  for (std::uint32_t i = kSharedRecords; i < 2 * kSharedRecords - 3; ++i)
    query_in_cycle(i, 2, evaluations);
  for (const std::uint32_t i : {0u, 1u, 3u, kSharedRecords, 2 * kSharedRecords - 4})
    EXPECT_EQ(evaluations[i].gap, i);
  EXPECT_EQ(evaluations.find(2), nullptr);
}

TEST(Evaluations, APartPairKeepsItsRecordForGood) {
  Evaluations evaluations(2 * kSharedRecords, 5);
  evaluations.keep(7);
  evaluations.share();
  query_in_cycle(7, 1, evaluations);
  for (std::uint32_t i = 8; i < 2 * kSharedRecords; ++i) query_in_cycle(i, i, evaluations);
  EXPECT_EQ(evaluations[7].gap, 7.0);
  EXPECT_EQ(evaluations.cycle(7), 1u);
}

// Every pair is in a zone, so that every pair is evaluated again and again.
TEST(Evaluations, BoundsHoldInAMonitorOfMorePairsThanRecords) {
  constexpr std::uint32_t kBodies = 190;
  std::vector<Object> objects;
  for (std::uint32_t i = 0; i < kBodies; ++i)
    objects.push_back(moving("body" + std::to_string(i), {block({0.1, 0.2, 0.15})}));
  Scene scene = cell_of(std::move(objects));
  ASSERT_GT(scene.pairs.size(), kSharedRecords);
  scene.pairs[5].publish = true;
  scene.zones.push_back(zone_over(scene, 50.0, 60.0));
  scene.budget = 3'000;
  Monitor monitor(scene);
  Random random(17);
  std::vector<PoseSample> samples;
  for (std::uint32_t i = 0; i < kBodies; ++i)
    samples.push_back(sample(i, {random.in_box(3.0), random.rotation()}, 0));
  std::size_t evaluated = 0;
  for (int tick = 1; tick <= 24; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    for (PoseSample& each : samples) {
      each.stamp_ns = now;
      each.world_from_object.position += random.in_box(0.002);
    }
    evaluated += monitor.tick(samples, now).queries;
    if (tick % 8 != 0) continue;
    for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
      const auto [a, b, publish] = scene.pairs[p];
      const DistanceBounds truth = fresh_distance(scene.objects[a], samples[a].world_from_object,
                                                  scene.objects[b], samples[b].world_from_object);
      const PairReport report = monitor.pair(p);
      ASSERT_LE(report.lower, truth.upper) << p;
      ASSERT_GE(report.upper, truth.lower) << p;
    }
  }
  EXPECT_GT(evaluated, 3 * kSharedRecords);
  EXPECT_FALSE(std::isnan(monitor.pair(5).distance)) << "a published pair keeps its record";
}

}  // namespace
}  // namespace clearance::test
