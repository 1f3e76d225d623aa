// The search for the depth, asked about bodies that do not overlap. Oracle: the exact distance.
#include <gtest/gtest.h>

#include <vector>

#include "core/penetration/depth.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using oracle::Body;

// Directions and features that a state may name, right and wrong ones.
std::vector<Separator> guesses(const ConvexBody& a, const ConvexBody& b, const RelativePose& pose,
                               Random& random) {
  const Vec3 between = pose.translation.normalized();
  std::vector<Separator> out = {{between}, {-between}, {random.direction()}};
  const auto any = [&](const ConvexBody& body) {
    return random.integer(0, static_cast<int>(body.facets.size()) - 1);
  };
  for (int k = 0; k < 3; ++k) {
    const std::int32_t facet_a = any(a), facet_b = any(b);
    out.push_back({a.facets[facet_a].normal, facet_a, kNone});
    out.push_back({-(pose.rotation * b.facets[facet_b].normal).normalized(), kNone, facet_b});
  }
  return out;
}

TEST(Depth, OfBodiesThatArePartedIsNoneAndBoundsTheirDistanceFromBelow) {
  int disjoint = 0;
  Random random(5);
  const Body bodies[] = {hard::box({0.9, 0.8, 0.7}), hard::facet_ball(4), hard::facet_ball(10),
                         hard::dual_ball(6)};
  for (const Body& body_a : bodies) {
    for (const Body& body_b : bodies) {
      DistanceJudge judge(body_a, body_b);
      for (const double apart : {1.7, 1.9, 2.0, 2.5, 10.0}) {
        const Pose b{apart * random.direction(), random.rotation()};
        const oracle::ExactDistance truth = judge.truth(Pose{}, b);
        if (!(truth.lower > 0.0)) continue;
        ++disjoint;
        const RelativePose pose = relative_pose(Pose{}, b);
        for (const Separator& guess : guesses(judge.a(), judge.b(), pose, random)) {
          const Depth found = depth(ActiveFeature(judge.a(), nullptr),
                                    ActiveFeature(judge.b(), &pose), pose, guess);
          EXPECT_LE(found.lower, 0.0) << apart;
          EXPECT_LE(-found.upper, truth.upper) << apart;
          EXPECT_NEAR(found.normal.norm(), 1.0, 1e-14) << apart;
        }
      }
    }
  }
  EXPECT_GT(disjoint, 30);
}

}  // namespace
}  // namespace clearance
