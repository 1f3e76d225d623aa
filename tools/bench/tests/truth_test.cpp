// Compares the reference distances of clearance-bench with exact rationals.
#include "tools/bench/truth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "tests/shared/exact_oracle.hpp"
#include "tools/bench/workload.hpp"

namespace clearance::bench {
namespace {

oracle::ExactBody hull_of_vertices(const ConvexBody& body) {
  oracle::Body hull;
  for (const Vertex& vertex : body.vertices) hull.points.push_back(vertex.position);
  return oracle::ExactBody(hull);
}

class BenchTruth : public testing::TestWithParam<std::string> {};

TEST_P(BenchTruth, IsOneOfTheDoublesAroundTheExactDistance) {
  constexpr std::size_t kEvery = 11;  // only every eleventh pose of a trajectory
  const Workload& load = workload(GetParam());
  for (std::size_t i = 0; i < load.trajectories.size(); ++i) {
    const Trajectory& t = load.trajectories[i];
    oracle::ExactBody a = hull_of_vertices(*t.a), b = hull_of_vertices(*t.b);
    for (std::size_t k = i % kEvery; k < t.poses.size(); k += kEvery) {
      const auto exact = oracle::exact_distance(a, t.poses[k].first, b, t.poses[k].second);
      const double said = load.truth[i][k].distance;
      EXPECT_TRUE(exact.lower <= said && said <= exact.upper)
          << "trajectory " << i << ", pose " << k << ": " << said - exact.lower << " off";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, BenchTruth,
                         testing::Values("f2", "v4", "f6", "boxes", "parallel-boxes", "links",
                                         "boxes/shallow", "links/middle"),
                         [](const auto& name) {
                           std::string word = name.param;
                           std::replace_if(
                               word.begin(), word.end(),
                               [](unsigned char c) { return std::ispunct(c) != 0; }, '_');
                           return word;
                         });

}  // namespace
}  // namespace clearance::bench
