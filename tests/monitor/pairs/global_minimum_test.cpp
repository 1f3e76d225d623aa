// The minimum of a tick over pairs with random bounds. The oracle is the definition: no other pair
// may be nearer than the minimum by more than rounding.
#include "monitor/pairs/global_minimum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <tuple>
#include <vector>

#include "tests/shared/every_choice.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

constexpr double kRounding = 2e-9;  // m

PairBounds evaluated(double lower, double upper) {
  return {.status = PairStatus::kConverged,
          .lower = lower,
          .upper = upper,
          .swept_lower = lower,
          .evaluated_cycle = 1};
}

bool is_certified(const std::vector<PairBounds>& pairs) {
  GlobalMinimum minimum;
  for (std::uint32_t i = 0; i < pairs.size(); ++i) minimum.add(i, pairs[i]);
  return minimum.certified();
}

TEST(GlobalMinimum, IsCertifiedOnlyIfNoOtherPairMayBeNearerHoweverWideThePairsAre) {
  Random random(20261127);
  int certified = 0;
  for (int trial = 0; trial < 20'000; ++trial) {
    std::vector<PairBounds> pairs;
    for (int i = 0; i < 6; ++i) {
      const double lower = random.uniform(-0.1, 1.0);
      const double width = i % 2 == 0 ? 1e-12 : random.log_uniform(1e-10, 1.0);
      pairs.push_back(evaluated(lower, lower + width));
    }
    const auto least = std::ranges::min_element(pairs, {}, &PairBounds::upper);
    const bool none_nearer = std::ranges::all_of(pairs, [&](const PairBounds& pair) {
      return &pair == &*least || pair.lower >= least->upper - kRounding;
    });
    ASSERT_LE(is_certified(pairs), none_nearer) << trial;
    certified += is_certified(pairs);
  }
  EXPECT_GT(certified, 2'000);
}

TEST(GlobalMinimum, OfPairsAtTheSameDistanceIsCertified) {
  EXPECT_TRUE(is_certified({evaluated(0.3, 0.3 + 1e-12), evaluated(0.3, 0.3 + 1e-12)}));
}

TEST(GlobalMinimum, MayItselfBeWide) {
  EXPECT_TRUE(is_certified({evaluated(0.1, 0.3), evaluated(0.3, 0.3)}));
  EXPECT_FALSE(is_certified({evaluated(0.1, 0.3), evaluated(0.2, 0.4)}));
}

// A tick knows nothing of a pair, or has bounds of this tick or of an earlier one.
PairBounds any_bounds(test::EveryChoice& choice) {
  // Exact in binary, so that upper bounds are equal although lower ones are not.
  constexpr double kLowers[] = {0.125, 0.25, 0.375}, kWidths[] = {0.0, 0.125};
  if (choice.flag()) return {};
  PairBounds bounds = evaluated(kLowers[choice.of(3)], 0.0);
  bounds.upper = bounds.lower + kWidths[choice.of(2)];
  const std::size_t when = choice.of(3);
  if (when > 0) bounds.status = PairStatus::kCarried;
  bounds.evaluated_cycle = when < 2 ? 1 : 0;
  return bounds;
}

TEST(GlobalMinimum, OfAnyThreePairsOfWhichOneComesTwiceIsTheOneWithTheLeastUpperBound) {
  constexpr double kRests[] = {kInfinity, 0.15, 0.9};
  test::EveryChoice choice;
  while (choice.next()) {
    GlobalMinimum minimum;
    std::vector<PairBounds> pairs;
    for (int i = 0; i < 3; ++i) pairs.push_back(any_bounds(choice));
    const bool is_reversed = choice.flag();
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t next = is_reversed ? 2 - i : i;
      minimum.add(next, pairs[next]);
    }
    const auto again = static_cast<std::uint32_t>(choice.of(3));
    minimum.add(again, pairs[again]);
    const double rest = kRests[choice.of(3)];
    minimum.add_rest(rest, rest);

    std::optional<std::uint32_t> least;
    bool any_unknown = false;
    double lower = rest;
    for (std::uint32_t i = 0; i < 3; ++i) {
      lower = std::min(lower, pairs[i].lower);
      any_unknown |= pairs[i].status == PairStatus::kUnknown;
      if (pairs[i].evaluated_cycle == 0) continue;
      const auto of = [&](std::uint32_t pair) {
        return std::tuple(pairs[pair].upper, pairs[pair].lower, pair);
      };
      if (!least || of(i) < of(*least)) least = i;
    }
    ASSERT_EQ(minimum.lower(), lower);
    ASSERT_EQ(minimum.swept_lower(), lower);
    ASSERT_EQ(minimum.known(), least.has_value());
    if (least) {
      ASSERT_EQ(minimum.pair(), *least);
    }
    if (any_unknown) continue;  // the tick adds none
    bool certified = least && rest >= pairs[*least].upper;
    for (std::uint32_t i = 0; certified && i < 3; ++i) {
      const bool is_exact =
          pairs[i].status == PairStatus::kConverged && pairs[i].upper == pairs[i].lower;
      certified = i == *least || is_exact || pairs[i].lower >= pairs[*least].upper;
    }
    ASSERT_EQ(minimum.certified(), certified) << "run " << choice.runs();
  }
  EXPECT_EQ(choice.runs(), 19u * 19u * 19u * 2u * 9u);
}

}  // namespace
}  // namespace clearance
