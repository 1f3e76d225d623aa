// Corners and edges so sharp that a point which is off their sides by no more than rounding may be
// past them by anything.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/nonsense_state.hpp"
#include "tests/shared/sharp_cases.hpp"

namespace clearance {
namespace {

std::string joined(const std::vector<std::string>& lines) {
  std::string out;
  for (const std::string& line : lines) out += "\n  " + line;
  return out;
}

// The answers that every state there is leads to.
TEST(SharpCorners, AreHeldToWhateverFeaturesAQueryBeginsAt) {
  std::vector<std::uint64_t> seeds{319};  // past the edge, and inside to rounding
  for (std::uint64_t seed = 1; seed <= 40; ++seed) seeds.push_back(seed);
  for (const std::uint64_t seed : seeds) {
    Random random(seed);
    const hard::HardCase c = hard::sharp_corners(random);
    DistanceJudge judge(c.a, c.b);
    ASSERT_EQ(judge.refusal(), "") << "seed " << seed;
    const oracle::ExactDistance truth = judge.truth(c.pose_a, c.pose_b);
    for (const TrackingState::Side& of_a : test::every_side(judge.a())) {
      for (const TrackingState::Side& of_b : test::every_side(judge.b())) {
        TrackingState state{of_a, of_b};
        const DistanceResult result = judge.ask(c.pose_a, c.pose_b, state);
        const auto faults = judge.faults(result, truth, c.pose_a, c.pose_b);
        ASSERT_TRUE(faults.empty())
            << "seed " << seed << ", from " << int{of_a.dimension} << '/' << of_a.feature << " and "
            << int{of_b.dimension} << '/' << of_b.feature << joined(faults);
      }
    }
  }
}

// A wedge 1e-17 rad wide, 1 m beside the origin, where its sides' lines are the same to rounding.
TEST(SharpCorners, OfAFacetEndItBelowATipThatPasses) {
  const ConvexPolyhedron wedge = test::made(oracle::Body{{{{0.0, 1.0, -1e-17}, 1.0},
                                                          {{0.0, -1.0, -1e-17}, -1.0},
                                                          {{0.0, 0.0, 1.0}, 1.0},
                                                          {{1.0, 0.0, 0.0}, 0.0},
                                                          {{-1.0, 0.0, 0.0}, 1.0}},
                                                         {}});
  const ConvexPolyhedron tip = test::made(
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

// A needle 1e-293 m thick: its sides' directions are the same in doubles, their lines parallel.
TEST(SharpCorners, EndANeedleThatDoublesTakeForAStrip) {
  constexpr double kThin = 1e-293;
  const ConvexPolyhedron needle = test::made(oracle::Body{
      {}, {{kThin, 0.0, 0.0}, {-kThin, kThin, 0.0}, {-kThin, -kThin, 0.0}, {0.0, 0.0, -1.0}}});
  const ConvexPolyhedron box = test::cube();
  const Pose below{{0.0, 0.0, -5.0}, Eigen::Quaterniond::Identity()};
  for (const TrackingState::Side& of_box : test::every_side(box)) {
    for (const TrackingState::Side& of_needle : test::every_side(needle)) {
      TrackingState state{of_box, of_needle};
      const DistanceResult r = distance(box, needle, below, Pose{}, state);
      EXPECT_LE(r.lower, 3.5);
      EXPECT_GE(r.upper, 3.5);
      EXPECT_LT(r.upper - r.lower, 1e-12);
    }
  }
}

TEST(SharpCorners, LimitTheirFacets) {
  // The sharp corners of a facet: none of a square's, one of a wedge's end, two of a thin rhomb's.
  const auto most = [](const ConvexPolyhedron& body) {
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
  const ConvexPolyhedron rhomb = prism_over(1e-9);
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
