// What the broad phase leaves out, against brute force: the closed form for every pair in every
// tick. Longer runs: CLEARANCE_TICKS=40000 monitor_tests --gtest_filter='*Adversary*'.
#include "monitor/broad_phase/broad_phase.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "monitor/monitor.hpp"
#include "tests/monitor/adversary_motion.hpp"
#include "tests/monitor/small_cells.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;

int ticks_of_a_run() {
  const char* asked = std::getenv("CLEARANCE_TICKS");
  return asked != nullptr ? std::atoi(asked) : 400;
}

enum class Style { kCrawl, kSpin, kTeleport, kDart, kCrowd, kAway, kLate };

// Long thin bodies, most of them moving, half of those with a stated speed; two zones. Every object
// is one part, so that a pair's staleness is that of its only row.
Scene bodies(Random& random) {
  std::vector<Object> objects;
  for (int i = 0; i < 22; ++i) {
    const Part part = i % 3 == 0 ? test::ball(0.05, random.pose(0.2))
                                 : test::capsule(random.uniform(0.3, 1.5), 0.01, random.pose(0.2));
    Object object =
        i < 16 ? test::moving("body", {part}) : test::fixed("post", {part}, random.pose(2.5));
    if (i % 2 == 0) object.max_speed = 3.0;
    object.margin = i % 4 == 0 ? 0.01 : 0.0;
    objects.push_back(std::move(object));
  }
  Scene scene = test::cell_of(std::move(objects));
  scene.zones = {test::zone_over(scene, 0.03, 0.05), test::zone_over(scene, 0.3, 0.3)};
  scene.zones[0].pairs.resize(80);
  scene.zones[1].pairs.erase(scene.zones[1].pairs.begin(), scene.zones[1].pairs.begin() + 120);
  for (std::size_t p = 0; p < scene.pairs.size(); p += 50) scene.pairs[p].publish = true;
  return scene;
}

// Where everything is, and what of it the monitor is told.
class Adversary {
 public:
  Adversary(const Scene& scene, Style style, std::uint64_t seed)
      : scene_(scene), style_(style), random_(seed), silent_(scene.objects.size(), 0) {
    for (const Object& object : scene.objects) {
      poses_.push_back(object.fixed ? object.world_from_object : random_.pose(2.5));
    }
    sent_ = judged_ = poses_;
  }

  const Report& tick(Monitor& monitor) {
    now_ns_ += kTick;
    ++tick_;
    std::vector<PoseSample> samples;
    for (std::uint32_t i = 0; i < poses_.size(); ++i) {
      if (scene_.objects[i].fixed) continue;
      move(poses_[i]);
      if (style_ == Style::kLate && silent_[i] == 0 && random_.uniform(0, 1) < 0.01) {
        silent_[i] = static_cast<int>(random_.uniform(1, 80));
      }
      if (silent_[i] > 0 && --silent_[i] > 0) continue;
      sent_[i] = poses_[i];
      samples.push_back(test::sample(i, poses_[i], now_ns_));
    }
    const Report& report = monitor.tick(samples, now_ns_);
    for (std::uint32_t i = 0; i < poses_.size(); ++i) {
      judged_[i] = monitor.input_age(i).stale ? poses_[i] : sent_[i];
    }
    return report;
  }

  // For the poses in use, and wherever late objects are.
  [[nodiscard]] long double truth(std::uint32_t pair) const {
    const auto& [a, b, publish] = scene_.pairs[pair];
    return test::true_distance(scene_.objects[a], judged_[a], scene_.objects[b], judged_[b]);
  }

 private:
  void move(Pose& pose) {
    switch (style_) {
      case Style::kLate:  // every point keeps to 3 m/s
      case Style::kCrawl:
        test::crawl(random_, pose);
        return;
      case Style::kSpin:
        test::turn(random_, 0.3, pose);
        return;
      case Style::kTeleport:
        pose.position += random_.in_box(1e-4);
        if (random_.uniform(0, 1) < 0.01) pose = random_.pose(2.5);
        return;
      case Style::kDart:
        if (tick_ % 60 > 56) pose.position += random_.in_box(0.3);
        return;
      case Style::kCrowd:
        test::crowd(random_, tick_, pose);
        return;
      case Style::kAway:  // farther than what is added up, and back
        pose.position += random_.in_box(0.001);
        if (random_.uniform(0, 1) < 0.003)
          pose = random_.pose(random_.uniform(0, 1) < 0.3 ? 3e4 : 2.5);
        return;
    }
  }
  const Scene& scene_;
  const Style style_;
  Random random_;
  std::vector<Pose> poses_, sent_, judged_;
  std::vector<int> silent_;
  int tick_ = 0;
  std::int64_t now_ns_ = kStart;
};

void judge_zone(const Scene& scene, const Zone& zone, const ZoneReport& report, bool was_active,
                bool all_fresh, const std::vector<long double>& truth) {
  long double least = kInfinity;
  for (const std::uint32_t p : zone.pairs) {
    const long double margins =
        static_cast<long double>(scene.objects[scene.pairs[p].first].margin) +
        scene.objects[scene.pairs[p].second].margin;
    least = std::min(least, truth[p] - margins);
  }
  ASSERT_LE(report.clearance, least);
  ASSERT_TRUE(report.active || least >= zone.enter_below) << "entered unseen";
  ASSERT_TRUE(report.active || !was_active || least > zone.leave_above) << "left too early";
  const bool for_what_was_between = report.clearance > zone.leave_above;
  if (report.active && report.proved && all_fresh && !for_what_was_between) {
    ASSERT_LE(least, zone.leave_above + 1e-9) << "proved, but not there";
  }
}

using StyleAndBudget = std::tuple<Style, std::uint32_t>;
class Adversaries : public testing::TestWithParam<StyleAndBudget> {};

INSTANTIATE_TEST_SUITE_P(
    BroadPhase, Adversaries,
    testing::Combine(testing::Values(Style::kCrawl, Style::kSpin, Style::kTeleport, Style::kDart,
                                     Style::kCrowd, Style::kAway, Style::kLate),
                     testing::Values(0u, 2u, 30u, 200u)));

TEST_P(Adversaries, FindNoBoundAboveTheTruthNoWrongMinimumAndNoEntryMissed) {
  const auto [style, budget] = GetParam();
  Random random(71);
  Scene scene = bodies(random);
  scene.budget = budget;
  Monitor monitor(scene);
  Adversary adversary(scene, style, 72 + budget);
  std::vector<long double> truth(scene.pairs.size());
  const int ticks = ticks_of_a_run();
  int proved = 0;
  for (int t = 0; t < ticks; ++t) {
    std::array<bool, 2> was_active{};
    const Report& report = adversary.tick(monitor);
    for (std::size_t z = 0; z < 2; ++z) {
      was_active[z] = report.zones[z].active != report.zones[z].changed;
    }
    ASSERT_LE(report.queries, budget);
    ASSERT_EQ(report.evaluated + report.carried + report.stale + report.unknown,
              report.pairs_total);
    std::array<std::uint32_t, 4> counted{};  // evaluated, carried, stale, unknown
    std::uint64_t stalest = 0;               // ticks
    for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
      truth[p] = adversary.truth(p);
      const PairReport pair = monitor.pair(p);
      ASSERT_LE(pair.lower, truth[p]) << "tick " << t << " pair " << p;
      ASSERT_GE(pair.upper, truth[p]) << "tick " << t << " pair " << p;
      ASSERT_GE(pair.lower, report.lower_all) << "tick " << t << " pair " << p;
      ++counted[pair.status <= PairStatus::kLoose ? 0 : static_cast<int>(pair.status) - 3];
      if (pair.status == PairStatus::kUnknown) continue;
      ASSERT_LE(pair.refresh_age_cycles, report.cycle - pair.evaluated_cycle);
      stalest = std::max(stalest, pair.refresh_age_cycles);
    }
    ASSERT_LE(stalest, report.oldest_evaluation_cycles) << "tick " << t;
    if (style != Style::kLate) {
      ASSERT_EQ(stalest, report.oldest_evaluation_cycles) << "tick " << t;
    }
    ASSERT_EQ(counted[0], report.evaluated);
    ASSERT_EQ(counted[1], report.carried);
    ASSERT_EQ(counted[2], report.stale);
    ASSERT_EQ(counted[3], report.unknown);
    const long double least = *std::min_element(truth.begin(), truth.end());
    ASSERT_LE(report.lower_all, least);
    const bool all_fresh = report.stale + report.unknown == 0;
    if (report.minimum_proved) {
      ++proved;
      ASSERT_TRUE(all_fresh);
      // Far from the origin, rounding decides between pairs that are as near as it is wide.
      ASSERT_LE(report.minimum.lower, least) << "tick " << t;
      ASSERT_GE(report.minimum.upper, least) << "tick " << t;
      ASSERT_LE(truth[report.minimum.pair] - least, 1e-9) << "tick " << t;
    }
    for (std::size_t z = 0; z < 2; ++z) {
      judge_zone(scene, scene.zones[z], report.zones[z], was_active[z], all_fresh, truth);
      if (HasFatalFailure()) FAIL() << "tick " << t << " zone " << z;
    }
    // 16 pairs a tick have their turn, and nobody was out of sight.
    if (budget == 200 && style != Style::kLate && t > 30) {
      ASSERT_LE(report.oldest_evaluation_cycles, 16u) << "tick " << t;
    }
  }
  if (budget == 200 && style != Style::kLate) {
    EXPECT_GE(proved, ticks - 1);
  }
}

TEST(BroadPhase, AThousandPairsThatStandStillCostNothing) {
  std::vector<Object> objects;
  for (int i = 0; i < 60; ++i) objects.push_back(test::moving("ball", {test::ball(0.1)}));
  Scene scene = test::cell_of(std::move(objects));
  scene.budget = 100;
  scene.refresh_s = 1e6;
  Monitor monitor(scene);
  std::uint32_t queries = 0;
  for (int t = 0; t < 100; ++t) {
    std::vector<PoseSample> samples;
    for (std::uint32_t i = 0; i < 60; ++i) {
      samples.push_back(test::sample(i, test::at(i, 0.01 * i * i, 0), kStart + t * kTick));
    }
    const Report& report = monitor.tick(samples, kStart + t * kTick);
    EXPECT_EQ(report.minimum_proved, t > 0) << "a thousand pairs are looked at in the first tick";
    queries = report.queries;
  }
  EXPECT_LE(queries, 20u) << "of 1770 pairs: those of the round, and the nearest";
}

TEST(BroadPhase, SaysSoWhenNotEveryPairHasBeenLookedAt) {
  std::vector<Object> objects;
  for (int i = 0; i < 60; ++i) objects.push_back(test::moving("ball", {test::ball(0.1)}));
  Scene scene = test::cell_of(std::move(objects));
  scene.budget = 10;
  Monitor monitor(scene);
  std::vector<PoseSample> samples;
  for (std::uint32_t i = 0; i < 60; ++i) {
    samples.push_back(test::sample(i, test::at(i, 0.01 * i * i, 0), kStart));
  }
  const Report& report = monitor.tick(samples, kStart);
  EXPECT_FALSE(report.minimum_proved) << "1000 of 1770 pairs a tick";
  EXPECT_EQ(report.lower_all, -kInfinity);
  EXPECT_TRUE(monitor.tick({}, kStart).minimum_proved);
  EXPECT_GT(monitor.tick({}, kStart).lower_all, 0.0);
}

}  // namespace
}  // namespace clearance
