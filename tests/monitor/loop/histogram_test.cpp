#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "monitor/loop/histogram.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

TEST(Histogram, IsZeroWhileEmpty) {
  const Histogram histogram;
  EXPECT_EQ(histogram.count(), 0u);
  EXPECT_EQ(histogram.max_ns(), 0);
  EXPECT_EQ(histogram.percentile_ns(0.5), 0);
}

TEST(Histogram, IsExactBelow64Nanoseconds) {
  Histogram histogram;
  for (std::int64_t ns = 0; ns < 64; ++ns) histogram.add(ns);
  EXPECT_EQ(histogram.percentile_ns(0.5), 31);
  EXPECT_EQ(histogram.percentile_ns(1.0), 63);
}

// Oracle: the sorted values.
TEST(Histogram, PercentilesAreNeverBelowTheTruthAndAtMostOneBinAbove) {
  Random random(11);
  std::vector<std::int64_t> values;
  Histogram histogram;
  for (int i = 0; i < 20000; ++i) {
    const auto ns = static_cast<std::int64_t>(std::exp2(random.uniform(0.0, 33.0)));
    values.push_back(ns);
    histogram.add(ns);
  }
  std::sort(values.begin(), values.end());
  for (const double share : {0.001, 0.1, 0.5, 0.9, 0.999, 1.0}) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * 20000.0));
    const std::int64_t truth = values[rank - 1];
    EXPECT_GE(histogram.percentile_ns(share), truth) << share;
    EXPECT_LE(histogram.percentile_ns(share), truth + truth / 64) << share;
  }
  EXPECT_EQ(histogram.max_ns(), values.back());
}

TEST(Histogram, KeepsTheMaximumOfWhatIsLongerThanItsLastBin) {
  Histogram histogram;
  histogram.add(1'000'000'000'000);
  histogram.add(-5);  // from a clock that was set back
  EXPECT_EQ(histogram.count(), 2u);
  EXPECT_EQ(histogram.max_ns(), 1'000'000'000'000);
  EXPECT_EQ(histogram.percentile_ns(0.5), 0);
}

}  // namespace
}  // namespace clearance
