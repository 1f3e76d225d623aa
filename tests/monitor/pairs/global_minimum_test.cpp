// The minimum of a tick over pairs with random bounds. The oracle is the definition: no other pair
// may be nearer than the minimum by more than rounding.
#include "monitor/pairs/global_minimum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

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

}  // namespace
}  // namespace clearance
