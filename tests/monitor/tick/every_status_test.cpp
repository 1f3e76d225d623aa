// All combinations of what is known of three balls around a post: what a report makes of its pairs.
//
// Oracle: the definitions of the minimum, of the counts and of a zone, over the list of all pairs.
// For the pairs themselves: where each ball is, and how far it may have come since its last pose.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "monitor/interface/tight_bounds.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/every_choice.hpp"

namespace clearance {
namespace {

constexpr double kRadius = 0.1, kEnter = 0.3, kLeave = 0.4, kMaxSpeed = 1.0;  // m, m/s
constexpr std::int64_t kLongNs = 40 * test::kTick;  // beyond the age limit

// The last knowledge of a ball, and its distance from the post, m.
struct Known {
  PairStatus status;
  double distance;
};
constexpr std::array kKnown = {
    Known{PairStatus::kOverlapping, -0.05}, Known{PairStatus::kConverged, 0.2},
    Known{PairStatus::kConverged, 0.35},    Known{PairStatus::kConverged, 0.8},
    Known{PairStatus::kStale, 0.35},        Known{PairStatus::kStale, 0.8},
    Known{PairStatus::kUnknown, 0.8},       Known{PairStatus::kAbsent, 0.8}};

using Balls = std::array<Known, 3>;

Scene post_and_balls(std::uint32_t budget) {
  std::vector<Object> objects = {test::fixed("post", {test::ball(kRadius)}, {})};
  for (const char* name : {"x", "y", "z"}) {
    objects.push_back(test::moving(name, {test::ball(kRadius)}));
    objects.back().max_speed = kMaxSpeed;
  }
  Scene scene = test::cell_of(objects);
  std::erase_if(scene.pairs, [](const ObjectPair& pair) { return pair.first != 0; });
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  scene.zones.push_back(test::zone_over(scene, kEnter, kLeave));
  scene.budget = budget;
  return scene;
}

Pose placed(std::uint32_t ball, double distance) {
  const double at = distance + 2 * kRadius;
  return test::at(ball == 0 ? at : 0.0, ball == 1 ? at : 0.0, ball == 2 ? at : 0.0);
}

bool counts(const PairReport& pair) { return pair.status != PairStatus::kAbsent; }

// No other pair may be nearer than the least upper bound, but for rounding of a fresh distance, and
// none may be late or unknown.
void expect_minimum(const Report& report, bool is_ample) {
  const PairReport* least = nullptr;
  double lower = kInfinity;
  for (const PairReport& pair : report.pairs) {
    if (counts(pair)) lower = std::min(lower, pair.lower);
    if (pair.status >= PairStatus::kUnknown || pair.evaluated_cycle == 0) continue;
    if (least == nullptr || pair.upper < least->upper) least = &pair;
  }
  ASSERT_EQ(report.minimum_known, least != nullptr);
  const bool none_nearer =
      least != nullptr && std::ranges::all_of(report.pairs, [&](const PairReport& pair) {
        const bool is_tight =
            pair.status <= PairStatus::kIterationLimit && are_tight(pair.lower, pair.upper);
        const bool is_late =
            pair.status == PairStatus::kStale || pair.status == PairStatus::kUnknown;
        return !is_late &&
               (&pair == least || !counts(pair) || is_tight || pair.lower >= least->upper);
      });
  // Bounds of pairs that the budget did not reach may be wider than those that are published.
  EXPECT_LE(report.minimum_certified, none_nearer);
  EXPECT_LE(report.lower_all, lower);
  if (is_ample) {
    EXPECT_EQ(report.minimum_certified, none_nearer);
    EXPECT_EQ(report.lower_all, lower);
  }
  if (least == nullptr) return;
  EXPECT_EQ(report.minimum.upper, least->upper);
  EXPECT_EQ(report.minimum.lower, least->lower);
}

void expect_counts(const Report& report) {
  std::array<std::uint32_t, 8> by_status{};
  for (const PairReport& pair : report.pairs) ++by_status[static_cast<std::size_t>(pair.status)];
  EXPECT_EQ(report.evaluated, by_status[0] + by_status[1] + by_status[2] + by_status[3]);
  EXPECT_EQ(report.carried, by_status[4]);
  EXPECT_EQ(report.stale, by_status[5]);
  EXPECT_EQ(report.unknown, by_status[6]);
  EXPECT_EQ(report.pairs_total, report.pairs.size());
}

// Active until all pairs were above the upper threshold since the last tick, once one was below the
// lower one.
void expect_zone(const Report& report, bool was_active) {
  const auto is_outside = [was_active](double lower) {
    return was_active ? lower > kLeave : lower >= kEnter;
  };
  bool is_active = false, is_proved = true, is_moving = false;
  for (const PairReport& pair : report.pairs) {
    if (!counts(pair)) continue;
    if (is_outside(pair.swept_lower)) continue;
    is_active = true;
    is_moving = is_moving || is_outside(pair.lower);
    is_proved = is_proved && pair.status <= PairStatus::kIterationLimit;
  }
  EXPECT_EQ(report.zones[0].active, is_active);
  if (!is_moving) {
    EXPECT_EQ(report.zones[0].certified, is_proved);
  }
}

void expect_pairs(const Report& report, const Balls& balls, double unseen, bool is_ample) {
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const auto [status, distance] = balls[i];
    const PairReport& pair = report.pairs[i];
    if (is_ample || status >= PairStatus::kStale || pair.status != PairStatus::kCarried) {
      EXPECT_EQ(pair.status, status) << i;
    }
    if (status >= PairStatus::kUnknown) {
      EXPECT_EQ(pair.lower, -kInfinity) << i;
      continue;
    }
    const double moved = status == PairStatus::kStale ? unseen : 0.0;
    EXPECT_LE(pair.lower, distance - moved + 1e-12) << i;
    EXPECT_GE(pair.upper, distance - 1e-12) << i;
    if (is_ample) {
      EXPECT_GE(pair.lower, distance - moved - 1e-6) << i;
    }
  }
}

TEST(EveryStatus, OfThreePairsHasTheMinimumTheCountsAndTheZoneOfTheirList) {
  test::EveryChoice choice;
  constexpr std::size_t kBudgets[] = {0, 1, 2, 100};
  while (choice.next() && !testing::Test::HasFailure()) {
    const std::size_t budget = kBudgets[choice.of(std::size(kBudgets))];
    const bool is_ample = budget > 3, was_near = choice.flag();
    Balls balls;
    for (Known& ball : balls) ball = kKnown[choice.of(kKnown.size())];
    const Scene scene = post_and_balls(static_cast<std::uint32_t>(budget));
    Monitor monitor(scene);
    for (std::uint32_t i = 0; i < 3; ++i)
      if (balls[i].status == PairStatus::kAbsent) monitor.set_absent(i + 1, true);
    std::int64_t now = test::kStart;
    bool was_active = false;
    // All balls that ever come are on time in the first two ticks, and in the last two those that
    // are not late.
    for (int tick = 0; tick < 4; ++tick) {
      now += tick == 2 ? kLongNs : test::kTick;
      std::vector<PoseSample> samples;
      for (std::uint32_t i = 0; i < 3; ++i) {
        const PairStatus status = balls[i].status;
        if (status >= PairStatus::kUnknown || (tick >= 2 && status == PairStatus::kStale)) continue;
        const double distance = tick == 0 && was_near ? 0.2 : balls[i].distance;
        samples.push_back(test::sample(i + 1, placed(i, distance), now));
      }
      const Report& report = monitor.tick(samples, now);
      SCOPED_TRACE(testing::Message() << "run " << choice.runs() << " tick " << tick);
      expect_minimum(report, is_ample);
      expect_counts(report);
      expect_zone(report, was_active);
      was_active = report.zones[0].active;
      const double unseen = 1e-9 * static_cast<double>(kLongNs + test::kTick) * kMaxSpeed;
      if (tick == 3) expect_pairs(report, balls, unseen, is_ample);
    }
  }
  EXPECT_EQ(choice.runs(), std::size_t{4 * 2 * 8 * 8 * 8});
}

}  // namespace
}  // namespace clearance
