// Random motions of one of two arms, or of both, with stops at random instants, against every
// answer 'free'. Oracle: moving_machine.hpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include "monitor/ask/asker.hpp"
#include "monitor/pairs/kept_near.hpp"
#include "tests/monitor/ask/moving_machine.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance {
namespace {

using test::first_seed;
using test::MovingMachine;

constexpr double kOfOracle = 2e-9;  // m: what the oracle rounds
// Streams of random numbers begin so many draws apart: those of successive seeds overlap.
constexpr std::uint64_t kStreams = 1'000'003;

// The least distance of the pairs that the first arms move, less what they have to keep.
double least_left(const Scene& scene, const std::vector<Pose>& poses, double margin,
                  const std::vector<std::uint32_t>& exempt, std::size_t arms = 1) {
  double least = kInfinity;
  for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
    const ObjectPair& of = scene.pairs[p];
    if (std::ranges::binary_search(exempt, p)) continue;
    const auto moves = [&](const Robot& robot) {
      return test::is_moved_link(scene, robot, of.first) ||
             test::is_moved_link(scene, robot, of.second);
    };
    if (std::ranges::any_of(std::span(scene.robots).first(arms), moves))
      least = std::min(least, test::distance_of(scene, p, poses) - margin);
  }
  return least;
}

// How far the bounds are below the sampled least, m.
struct Loose {
  std::vector<double> below;

  [[nodiscard]] double quantile(double share) {
    std::ranges::sort(below);
    return below[static_cast<std::size_t>(share * static_cast<double>(below.size() - 1))];
  }
  void show(const char* path) {
    std::cout << path << ": " << below.size() << " bounds, median " << 1e3 * quantile(0.5)
              << " mm, p95 " << 1e3 * quantile(0.95) << " mm, most " << 1e3 * quantile(1.0)
              << " mm below the sampled least\n";
  }
};

// CLEARANCE_STOPS_SEED: the first of the scenes.
TEST(StoppableCampaign, NoSampledStopContradictsAnAnswer) {
  std::size_t free = 0, below = 0, undecided = 0, samples = 0;
  for (std::uint64_t seed = first_seed(); seed < first_seed() + repeats(60); ++seed) {
    const Scene scene = test::drawn_scene(seed * kStreams);
    std::vector<std::vector<std::uint32_t>> exempt;
    for (const double margin : {0.0, 0.02, 0.05}) exempt.push_back(kept_nearer(scene, margin));
    MovingMachine machine(scene, seed * kStreams);
    Asker asker(scene);
    for (int i = 0; i < 20; ++i) {
      const Question question = machine.draw(i % 3 == 0);
      Answer answer;
      const auto text = asker.ask(question, answer);
      ASSERT_FALSE(text) << *text;
      for (const MarginAnswer& margin : answer.margins) {
        free += margin.verdict == Verdict::kFree;
        below += margin.verdict == Verdict::kBelow;
        undecided += margin.verdict == Verdict::kUndecided;
      }
      for (int k = 0; k < 30; ++k) {
        const std::vector<Pose> poses = machine.drawn_instant(k % 4 == 0);
        for (std::size_t m = 0; m < answer.margins.size(); ++m) {
          if (answer.margins[m].verdict != Verdict::kFree) continue;
          const double margin = question.margins[m];
          EXPECT_GE(least_left(scene, poses, margin, exempt[m]), -kOfOracle)
              << "seed " << seed << ", " << i << ", margin " << margin;
          ++samples;
        }
      }
    }
  }
  EXPECT_GT(free, 100u);
  EXPECT_GT(below, 100u);
  EXPECT_EQ(undecided, 0u);
  EXPECT_GT(samples, 1'000u);
  if (std::getenv("CLEARANCE_STOPS_SHOW") != nullptr)
    std::cout << free << " free, " << below << " below, " << samples << " samples\n";
}

TEST(StoppableCampaign, NoSampledStopOfTwoArmsContradictsAnAnswer) {
  std::size_t free = 0, below = 0, samples = 0;
  for (std::uint64_t seed = first_seed(); seed < first_seed() + repeats(60); ++seed) {
    const Scene scene = test::drawn_scene(seed * kStreams);
    MovingMachine machine(scene, seed * kStreams);
    const std::vector<std::uint32_t> exempt = kept_nearer(scene, 0.02);
    Asker asker(scene);
    for (int i = 0; i < 20; ++i) {
      Question question = machine.draw(i % 3 == 0, true);
      question.time_scaling = i % 2 == 0;
      question.margins = {0.02};
      Answer answer;
      const auto text = asker.ask(question, answer);
      ASSERT_FALSE(text) << *text;
      const bool is_free = answer.margins[0].verdict == Verdict::kFree;
      free += is_free;
      below += !is_free;
      const double factor = answer.scaling.factor;
      const bool is_slower = question.time_scaling && question.others == OthersMove::kNot;
      if (!is_free && !(is_slower && factor > 0.0)) continue;
      if (is_slower) machine.slow_down(factor);
      for (int k = 0; k < 30; ++k, ++samples)
        EXPECT_GE(least_left(scene, machine.drawn_instant_together(k % 4 == 0), 0.02, exempt, 2),
                  -kOfOracle)
            << "seed " << seed << ", " << i;
    }
  }
  EXPECT_GT(free, 10u);
  EXPECT_GT(below, 10u);
  EXPECT_GT(samples, 1'000u);
  if (std::getenv("CLEARANCE_STOPS_SHOW") != nullptr)
    std::cout << free << " free, " << below << " below, " << samples << " samples of two arms\n";
}

TEST(StoppableCampaign, NoSampledStopOfTheSlowerMotionContradictsATimeScaling) {
  std::size_t slower = 0, samples = 0;
  for (std::uint64_t seed = first_seed(); seed < first_seed() + repeats(60); ++seed) {
    const Scene scene = test::drawn_scene(seed * kStreams);
    const std::vector<std::uint32_t> exempt = kept_nearer(scene, 0.02);
    MovingMachine machine(scene, seed * kStreams);
    Asker asker(scene);
    for (int i = 0; i < 10; ++i) {
      Question question = machine.draw(false);
      question.margins = {0.02};
      question.time_scaling = true;
      Answer answer;
      ASSERT_FALSE(asker.ask(question, answer));
      const double factor = answer.scaling.factor;
      EXPECT_EQ(factor == 1.0, answer.margins[0].verdict == Verdict::kFree);
      if (factor == 0.0) continue;
      slower += factor < 1.0;
      Question slow = machine.slow_down(factor);
      slow.margins = question.margins;
      Answer of_slow;
      ASSERT_FALSE(asker.ask(slow, of_slow));
      EXPECT_EQ(of_slow.margins.front().verdict, Verdict::kFree) << "seed " << seed << ", " << i;
      for (int k = 0; k < 20; ++k, ++samples)
        EXPECT_GE(least_left(scene, machine.drawn_instant(k % 2 == 0), 0.02, exempt), -kOfOracle);
    }
  }
  EXPECT_GT(slower, 5u);
  EXPECT_GT(samples, 100u);
}

// CLEARANCE_STOPS_SHOW prints the figures of monitor/ask/PLANNED_STOPS.md.
TEST(StoppableCampaign, BoundsAreBelowAllSampledStopsButNotFar) {
  Loose kept, left;
  for (std::uint64_t seed = first_seed(); seed < first_seed() + repeats(80); ++seed) {
    const Scene scene = test::drawn_scene(seed * kStreams);
    MovingMachine machine(scene, seed * kStreams);
    Asker asker(scene);
    for (int i = 0; i < 8; ++i) {
      const Question question = machine.draw(false);
      Answer answer;
      ASSERT_FALSE(asker.ask(question, answer));
      if (!(answer.lower > 0.0) && i > 1) continue;
      double sampled = kInfinity;
      for (int k = 0; k < 400; ++k)
        sampled = std::min(sampled, least_left(scene, machine.drawn_instant(k % 2 == 0), 0.0, {}));
      EXPECT_LE(answer.lower, std::max(0.0, sampled) + kOfOracle) << "seed " << seed << ", " << i;
      if (answer.lower > 0.0 && !question.only_margins)
        (scene.robots[0].stopping.keeps_path ? kept : left).below.push_back(sampled - answer.lower);
    }
  }
  ASSERT_GT(kept.below.size(), 10u);
  ASSERT_GT(left.below.size(), 10u);
  if (std::getenv("CLEARANCE_STOPS_SHOW") != nullptr) {
    kept.show("path kept");
    left.show("path left");
  }
  EXPECT_LT(kept.quantile(0.5), 5e-3);
  EXPECT_LT(left.quantile(0.5), 40e-3);
}

}  // namespace
}  // namespace clearance
