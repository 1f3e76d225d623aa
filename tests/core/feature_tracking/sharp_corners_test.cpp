// Corners and edges so sharp that a point may be outside their sides by no more than rounding, and
// yet be any distance past them.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/every_start.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/repeats.hpp"
#include "tests/shared/sharp_cases.hpp"

namespace clearance {
namespace {

// Checks the answers from every possible initial state.
TEST(SharpCorners, AreHeldToWhateverFeaturesAQueryBeginsAt) {
  std::vector<std::uint64_t> seeds{319};  // this one is past the edge, and inside within rounding
  for (std::uint64_t seed = 1; seed <= repeats(40); ++seed) seeds.push_back(seed);
  for (const std::uint64_t seed : seeds) {
    Random random(seed);
    const hard::HardCase c = hard::sharp_corners(random);
    DistanceJudge judge(c.a, c.b);
    ASSERT_EQ(judge.refusal(), "") << "seed " << seed;
    ASSERT_EQ(test::fault_from_any_start(judge, c.pose_a, c.pose_b), "") << "seed " << seed;
  }
}

// A wedge of 2e-12 rad, 1 m beside the origin.
TEST(SharpCorners, OfAFacetEndItBelowATipThatPasses) {
  const ConvexBody wedge = test::made(oracle::Body{{{{0.0, 1.0, -1e-12}, 1.0},
                                                    {{0.0, -1.0, -1e-12}, -1.0},
                                                    {{0.0, 0.0, 1.0}, 1.0},
                                                    {{1.0, 0.0, 0.0}, 0.0},
                                                    {{-1.0, 0.0, 0.0}, 1.0}},
                                                   {}});
  const ConvexBody tip = test::made(
      oracle::Body{{}, {{0.0, 0.0, 0.0}, {1.0, 0.5, -0.5}, {1.0, -0.5, -0.5}, {1.0, 0.0, -1.0}}});
  TrackingState state;
  for (int k = 16; k >= -16; --k) {
    const double along = k / 32.0, beyond = std::min(0.0, along);
    const Pose above{{0.5, 1.0, along}, Eigen::Quaterniond::Identity()};
    const DistanceResult r = distance(tip, wedge, above, Pose{}, state);
    EXPECT_LE(r.lower, std::hypot(0.5, beyond)) << along;
    EXPECT_GE(r.upper, std::hypot(0.5, beyond)) << along;
    EXPECT_LT(r.upper - r.lower, 1e-13) << along;
  }
}

TEST(SharpCorners, LimitTheirFacets) {
  // The number of sharp corners of a facet: none for a square, one for a wedge's end, two for a
  // thin rhombus.
  const auto most = [](const ConvexBody& body) {
    std::int32_t out = 0;
    for (const Facet& facet : body.facets) out = std::max(out, facet.limits - facet.sides);
    return out;
  };
  const auto prism_over = [](double half_width) {
    std::vector<Vec3> points;
    for (const double z : {0.0, 1.0}) {
      for (const double side : {-1.0, 1.0}) {
        points.emplace_back(side, 0.0, z);
        points.emplace_back(0.0, side * half_width, z);
      }
    }
    return test::made(oracle::Body{{}, points});
  };
  EXPECT_EQ(most(test::cube()), 0);
  EXPECT_EQ(most(prism_over(0.5)), 0);
  EXPECT_EQ(most(prism_over(0.3)), 2);
  const ConvexBody rhomb = prism_over(1e-9);
  for (const Facet& facet : rhomb.facets) {
    if (facet.sides + 2 != facet.limits) continue;
    for (std::int32_t i = facet.sides; i < facet.limits; ++i) {
      const FacetLimit limit = rhomb.limit_of(facet, i);
      EXPECT_NEAR(limit.inward.dot(Vec3(2.0, 0.0, 0.0)) - limit.offset,
                  limit.inward.x() > 0.0 ? 3.0 : -1.0, 1e-15);
    }
  }
}

}  // namespace
}  // namespace clearance
