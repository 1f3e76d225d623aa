// The budget that refreshes every pair in time.
//
// Oracle: ticks that evaluate whole pairs, one after the other, as long as the budget lasts.
#include "config/scene/refresh_share.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tests/shared/random.hpp"

namespace clearance {
namespace {

// Returns the number of ticks that evaluate all pairs once. No pair may need more than the budget.
std::uint64_t ticks_for(const std::vector<std::uint64_t>& pairs, std::uint64_t budget) {
  std::uint64_t ticks = 1, left = budget;
  for (const std::uint64_t part_pairs : pairs) {
    if (part_pairs > left) ++ticks, left = budget;
    left -= part_pairs;
  }
  return ticks;
}

TEST(RefreshCost, QueriesOfEachTickRefreshAllPairsInTimeWhateverTheirOrder) {
  Random random(338);
  for (int trial = 0; trial < 20'000; ++trial) {
    std::vector<std::uint64_t> pairs(static_cast<std::size_t>(random.integer(1, 12)));
    for (std::uint64_t& part_pairs : pairs)
      part_pairs = static_cast<std::uint64_t>(random.integer(1, 40));
    const auto ticks = static_cast<std::uint64_t>(random.integer(1, 15));
    RefreshCost cost;
    for (const std::uint64_t part_pairs : pairs) cost.add(part_pairs);
    const std::uint64_t queries = cost.queries(ticks);
    ASSERT_GE(queries, std::ranges::max(pairs)) << trial;
    EXPECT_LE(ticks_for(pairs, queries), ticks) << trial;
    EXPECT_LE(queries, cost.part_pairs) << "one tick is enough for all";
    EXPECT_LE(queries, cost.part_pairs / ticks + std::ranges::max(pairs)) << trial;
  }
}

}  // namespace
}  // namespace clearance
