#include "monitor/schedule/refresh_budget.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "tests/shared/random.hpp"

namespace clearance {
namespace {

// The oracle follows the specification literally. Pairs form a ring, and a pair is refreshed only
// when the budget for all of its queries is left. No pair may wait longer than the promised number
// of ticks.
TEST(RefreshBudget, LetsEveryPairBeRefreshedInTimeFromNoMoreThanIsKept) {
  Random random(31);
  for (int run = 0; run < 200; ++run) {
    const auto ticks = static_cast<std::uint64_t>(random.integer(1, 60));
    std::vector<std::uint64_t> rows(static_cast<std::size_t>(random.integer(1, 80)));
    RefreshCost pairs;
    for (std::uint64_t& of_one : rows) {
      of_one = static_cast<std::uint64_t>(random.integer(0, 3) == 0 ? random.integer(1, 40) : 1);
      pairs.add(of_one);
    }
    RefreshBudget pace(pairs, ticks, true);
    std::vector<std::uint64_t> last(rows.size(), 0);
    std::size_t next = 0;
    for (std::uint64_t t = 1; t < 5 * ticks; ++t) {
      pace.begin_tick();
      ASSERT_LE(pace.kept(), pairs.queries(ticks)) << "run " << run;
      const int gift = random.integer(0, 20) == 0 ? random.integer(0, 90) : 0;
      std::uint64_t left = pace.kept() + static_cast<std::uint64_t>(gift), spent = 0, turns = 0;
      while (turns < rows.size() && rows[next] <= left) {
        left -= rows[next];
        spent += rows[next];
        last[next] = t;
        next = (next + 1) % rows.size();
        ++turns;
      }
      turns == rows.size() ? pace.all_refreshed()
                           : pace.end_tick(static_cast<std::uint32_t>(spent));
      for (const std::uint64_t turn : last) ASSERT_LE(t - turn, ticks) << "run " << run;
    }
  }
}

TEST(RefreshBudget, KeepsNothingForPairsThatTheBudgetDoesNotCover) {
  RefreshBudget pace({.part_pairs = 100, .most = 10}, 10, false);
  for (int t = 0; t < 100; ++t) {
    pace.begin_tick();
    ASSERT_EQ(pace.kept(), 0u);
    pace.end_tick(0);
  }
}

// One of 25 pairs is due every 400 ticks, which hardly affects urgent pairs.
TEST(RefreshBudget, KeepsAQueryOnlyWhenOneIsDue) {
  RefreshBudget pace({.part_pairs = 24, .most = 1}, 10'000, true);
  std::vector<std::uint32_t> kept;
  for (int t = 0; t < 10'000; ++t) {
    pace.begin_tick();
    kept.push_back(pace.kept());
    pace.end_tick(pace.kept());
  }
  EXPECT_EQ(std::accumulate(kept.begin(), kept.end(), 0u), 25u);
}

}  // namespace
}  // namespace clearance
