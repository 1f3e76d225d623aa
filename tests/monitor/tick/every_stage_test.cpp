// Three balls make all sequences of moves in three ticks. Each stage of a tick then meets every
// state that earlier ticks can leave.
//
// Oracle: the distance of two balls on two axes, in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/every_choice.hpp"

namespace clearance {
namespace {

constexpr double kRadius = 0.1, kEnter = 0.15, kLeave = 0.25;  // m
// Each ball lies on its own axis, at one of these distances from the origin, m. Two of them
// overlap, are within the zone, between its thresholds, or far from it.
constexpr std::array kPlaces = {0.05, 0.3, 2.0};
constexpr std::size_t kBalls = 3, kEvents = 1 + kBalls * kPlaces.size();  // the first: none moves

using Balls = std::array<double, kBalls>;

Scene three_balls(std::uint32_t budget, bool publish) {
  Scene scene =
      test::cell_of(std::vector<Object>(kBalls, test::moving("ball", {test::ball(kRadius)})));
  for (std::size_t i = 0; i < kBalls; ++i) scene.objects[i].name += std::to_string(i);
  for (ObjectPair& pair : scene.pairs) pair.publish = publish;
  scene.zones.push_back(test::zone_over(scene, kEnter, kLeave));
  scene.budget = budget;
  return scene;
}

std::vector<PoseSample> samples_of(const Balls& balls, std::int64_t now) {
  std::vector<PoseSample> samples;
  for (std::uint32_t i = 0; i < kBalls; ++i) {
    Vec3 at = Vec3::Zero();
    at[i] = balls[i];
    samples.push_back(test::sample(i, {at, Pose{}.orientation}, now));
  }
  return samples;
}

// Returns the distances in the order of Scene::pairs.
std::array<double, 3> distances(const Balls& balls) {
  const auto between = [&](std::size_t a, std::size_t b) {
    return std::hypot(balls[a], balls[b]) - 2 * kRadius;
  };
  return {between(0, 1), between(0, 2), between(1, 2)};
}

struct Seen {
  std::uint64_t evaluated = 0, carried = 0, active = 0, inactive = 0, not_certified = 0;
};

void expect_true(const Report& report, const Balls& balls, Seen& seen) {
  constexpr double kRounding = 1e-12;
  const auto all = distances(balls);
  const double least = std::ranges::min(all);
  EXPECT_LE(report.lower_all, least + kRounding);
  if (report.minimum_certified) {
    EXPECT_LE(report.minimum.lower, least + kRounding);
  }
  if (report.minimum_known) {
    EXPECT_GE(report.minimum.upper, least - kRounding);
  }
  for (std::size_t i = 0; i < report.pairs.size(); ++i) {
    EXPECT_LE(report.pairs[i].lower, all[i] + kRounding) << i;
    EXPECT_GE(report.pairs[i].upper, all[i] - kRounding) << i;
  }
  const ZoneReport& zone = report.zones[0];
  const bool was_active = zone.active != zone.changed;
  if (least < (was_active ? kLeave : kEnter)) {
    EXPECT_TRUE(zone.active);
  }
  seen.evaluated += report.evaluated;
  seen.carried += report.carried;
  ++(report.zones[0].active ? seen.active : seen.inactive);
  if (!report.minimum_certified) ++seen.not_certified;
}

TEST(EveryStage, IsTrueAfterAllSequencesOfWhatThreeBallsDo) {
  test::EveryChoice choice;
  constexpr std::size_t kBudgets[] = {0, 1, 2, 100};
  constexpr double kTight = 1e-6;  // m
  Seen seen;
  while (choice.next() && !testing::Test::HasFailure()) {
    const std::size_t budget = kBudgets[choice.of(std::size(kBudgets))];
    const bool is_published = choice.flag();
    Balls balls;
    balls.fill(kPlaces[choice.of(kPlaces.size())]);
    const Scene scene = three_balls(static_cast<std::uint32_t>(budget), is_published);
    Monitor monitor(scene);
    std::int64_t now = test::kStart;
    const auto tick = [&]() -> const Report& {
      now += test::kTick;
      const Report& report = monitor.tick(samples_of(balls, now), now);
      SCOPED_TRACE(testing::Message() << "run " << choice.runs() << ", budget " << budget);
      expect_true(report, balls, seen);
      EXPECT_EQ(report.pairs.size(), is_published ? kBalls : 0u);
      if (budget > kBalls) {
        EXPECT_TRUE(report.minimum_certified);
      }
      return report;
    };
    static_cast<void>(tick());
    for (int step = 0; step < 3; ++step) {
      const std::size_t event = choice.of(kEvents);
      if (event > 0) balls[(event - 1) / kPlaces.size()] = kPlaces[(event - 1) % kPlaces.size()];
      static_cast<void>(tick());
    }
    if (budget == 0) continue;
    // Nothing moves any more. A used-up budget raises lower_all by a few millimetres a tick. In the
    // end, the bounds are tight.
    const double least = std::ranges::min(distances(balls));
    const auto is_tight = [&](const Report& report) {
      return report.lower_all >= least - kTight && report.minimum_known &&
             report.minimum.upper <= least + kTight;
    };
    const Report* report = &tick();
    for (int rest = 0; rest < 1500 && !is_tight(*report); ++rest) report = &tick();
    EXPECT_TRUE(is_tight(*report)) << choice.runs();
    if (least > kLeave) {
      EXPECT_FALSE(report->zones[0].active) << choice.runs();
    }
  }
  EXPECT_EQ(choice.runs(), std::size(kBudgets) * 2 * kPlaces.size() * kEvents * kEvents * kEvents);
  for (const std::uint64_t count :
       {seen.evaluated, seen.carried, seen.active, seen.inactive, seen.not_certified})
    EXPECT_GT(count, 1000u);
}

}  // namespace
}  // namespace clearance
