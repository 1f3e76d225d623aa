#include "tests/monitor/adversary/judge.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace clearance::test {
namespace {

constexpr int kInstants = 3;      // instants tried between two ticks, for every pair
constexpr int kSettled = 30;      // ticks after which every pair has been evaluated
constexpr double kPoses = 1e-11;  // rounding of interpolated poses, m
constexpr double kFar = 1e-8;     // rounding of poses 30 km away, m

}  // namespace

Judge::Judge(const Scene& scene, const Oracle& oracle, Style style, bool budget_is_ample)
    : scene_(scene),
      oracle_(oracle),
      style_(style),
      ample_(budget_is_ample),
      share_(refresh_share(scene)),
      rounding_(style == Style::kAway ? kFar : kPoses),
      now_(scene.pairs.size()),
      since_(scene.pairs.size()),
      known_for_(scene.pairs.size(), 0) {}

bool Judge::accepts(const Report& report, const Monitor& monitor, Adversary& adversary) {
  ++tick_;
  const testing::ScopedTrace trace(__FILE__, __LINE__, "tick " + std::to_string(tick_));
  find_truth(adversary);
  EXPECT_LE(report.queries, scene_.budget);
  judge_pairs(report, monitor);
  judge_counts(report);
  judge_minimum(report);
  for (std::size_t z = 0; z < scene_.zones.size(); ++z) {
    judge_zone(scene_.zones[z], report.zones[z], report.stale + report.unknown == 0);
  }
  judge_turns(report);
  return !testing::Test::HasFailure();
}

void Judge::find_truth(Adversary& adversary) {
  for (std::uint32_t p = 0; p < scene_.pairs.size(); ++p) {
    const auto& [a, b, publish] = scene_.pairs[p];
    const Object& object_a = scene_.objects[a];
    const Object& object_b = scene_.objects[b];
    now_[p] = oracle_.distance(object_a, adversary.now(a), object_b, adversary.now(b));
    since_[p] = now_[p];
    for (int i = 0; i < kInstants && adversary.was_known(p); ++i) {
      const double s = adversary.any_instant();
      since_[p] = std::min(since_[p], oracle_.distance(object_a, adversary.since(a, s), object_b,
                                                       adversary.since(b, s)));
    }
  }
}

void Judge::judge_pairs(const Report& report, const Monitor& monitor) {
  counted_ = {};
  stalest_ = 0;
  for (std::uint32_t p = 0; p < scene_.pairs.size(); ++p) {
    const testing::ScopedTrace trace(__FILE__, __LINE__, "pair " + std::to_string(p));
    const PairReport pair = monitor.pair(p);
    judge_bounds(p, pair);
    EXPECT_GE(pair.lower, report.lower_all);
    ++counted_[pair.status <= PairStatus::kIterationLimit
                   ? 0
                   : static_cast<std::size_t>(pair.status) - 3];
    judge_age(p, pair, report.cycle);
  }
}

bool Judge::is_bounded(std::uint32_t pair) const {
  const auto bounded = [](const Object& object) {
    return std::all_of(object.parts.begin(), object.parts.end(),
                       [](const Part& part) { return part.shape.bounded(); });
  };
  return bounded(scene_.objects[scene_.pairs[pair].first]) &&
         bounded(scene_.objects[scene_.pairs[pair].second]);
}

void Judge::judge_bounds(std::uint32_t pair, const PairReport& report) const {
  const long double rounding = oracle_.rounding > 0.0 ? rounding_ : 0.0L;
  EXPECT_LE(report.lower, now_[pair] + rounding);
  EXPECT_GE(report.upper, now_[pair] - rounding);
  EXPECT_LE(report.swept_lower, since_[pair] + rounding_);
  EXPECT_LE(report.swept_lower, report.lower);
  const bool known = report.status != PairStatus::kUnknown;
  EXPECT_TRUE(report.lower > -kInfinity || !known || !is_bounded(pair))
      << "spheres bound every known pair of bounded objects";
}

void Judge::judge_age(std::uint32_t pair, const PairReport& report, std::uint64_t cycle) {
  known_for_[pair] = report.status == PairStatus::kUnknown ? 0 : known_for_[pair] + 1;
  if (known_for_[pair] == 0) return;
  stalest_ = std::max(stalest_, report.refresh_age_cycles);
  const auto& [a, b, publish] = scene_.pairs[pair];
  if (scene_.objects[a].parts.size() == 1 && scene_.objects[b].parts.size() == 1) {
    EXPECT_LE(report.refresh_age_cycles, cycle - report.evaluated_cycle);
  }
  // If the budget covers the refreshes at all, each pair is refreshed in time, whatever else is
  // urgent.
  if (scene_.budget > 0 && share_.queries() <= scene_.budget && known_for_[pair] > share_.ticks) {
    EXPECT_LE(report.refresh_age_cycles, share_.ticks);
  }
}

void Judge::judge_counts(const Report& report) const {
  EXPECT_EQ(counted_[0], report.evaluated);
  EXPECT_EQ(counted_[1], report.carried);
  EXPECT_EQ(counted_[2], report.stale);
  EXPECT_EQ(counted_[3], report.unknown);
  EXPECT_EQ(report.evaluated + report.carried + report.stale + report.unknown, report.pairs_total);
}

void Judge::judge_minimum(const Report& report) const {
  const long double rounding = oracle_.rounding > 0.0 ? rounding_ : 0.0L;
  const long double least = *std::min_element(now_.begin(), now_.end());
  EXPECT_LE(report.lower_all, least + rounding);
  EXPECT_LE(report.swept_lower_all, *std::min_element(since_.begin(), since_.end()) + rounding_);
  EXPECT_TRUE(report.minimum_known == (scene_.budget > 0) || report.unknown > 0);
  if (!report.minimum_certified) return;
  EXPECT_EQ(report.stale + report.unknown, 0u);
  EXPECT_LE(report.minimum.lower, least + rounding);
  EXPECT_GE(report.minimum.upper, least - rounding);
  // Between pairs whose distances differ by less than the rounding, rounding decides.
  EXPECT_LE(now_[report.minimum.pair] - least, rounding_);
}

void Judge::judge_zone(const Zone& zone, const ZoneReport& report, bool all_fresh) {
  long double now = kInfinity, since = kInfinity;
  for (const std::uint32_t p : zone.pairs) {
    const long double margins =
        static_cast<long double>(scene_.objects[scene_.pairs[p].first].margin) +
        scene_.objects[scene_.pairs[p].second].margin;
    now = std::min(now, now_[p] - margins);
    since = std::min(since, since_[p] - margins);
  }
  const bool was_active = report.active != report.changed;
  EXPECT_LE(report.clearance, now + rounding_);
  EXPECT_LE(report.swept_clearance, since + rounding_);
  EXPECT_LE(report.swept_clearance, report.clearance);
  EXPECT_TRUE(report.active || since + rounding_ >= zone.enter_below) << "entered unseen";
  EXPECT_TRUE(report.active || !was_active || since + rounding_ > zone.leave_above)
      << "left too early";
  const bool for_what_was_between = report.clearance > zone.leave_above;
  if (report.active && report.certified && all_fresh && !for_what_was_between) {
    EXPECT_LE(now, zone.leave_above + 1e-9) << "certified, but not there";
  }
  uncertain_zones_ += tick_ > kSettled && !report.certified;
}

void Judge::judge_turns(const Report& report) const {
  EXPECT_LE(stalest_, report.oldest_evaluation_cycles);
  if (falls_silent(style_)) return;
  if (style_ != Style::kLost) {
    EXPECT_EQ(stalest_, report.oldest_evaluation_cycles);
  }
  if (!ample_ || tick_ <= kSettled) return;
  EXPECT_LE(report.oldest_evaluation_cycles, 16u) << "16 pairs a tick have their turn";
  // At 30 km the core's rounding error exceeds the difference between two pairs.
  EXPECT_TRUE(report.minimum_certified || (style_ == Style::kAway && oracle_.rounding > 0.0));
}

}  // namespace clearance::test
