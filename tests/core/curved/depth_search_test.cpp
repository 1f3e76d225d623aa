// The depth that the cover of all directions certifies, before rounding errors widen it. Oracle:
// the least overlap over directions that are sampled, which is never below the depth.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/curved/thorough.hpp"
#include "core/shapes.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

// The cover stops where the depth may still be less by the tolerance. The smallest one is 2^-49 of
// the pair's size, and every later one is larger.
TEST(DepthSearch, CertifiesTheDepthThatItFoundLessTheToleranceOfItsCover) {
  Random random(67);
  for (int k = 0; k < 20; ++k) {
    const ConvexBody a = test::made(ellipsoid({0.6, 0.9, random.uniform(1.2, 1.5)}));
    const ConvexBody b = test::made(truncated_cone(0.7, random.uniform(0.3, 0.5), 0.8));
    const RelativePose pose = relative_pose(Pose{}, random.pose(0.4));
    CurvedPair pair(a, b, pose);
    const Vec3 first = random.in_box(1.0).normalized();
    (void)pair.support(first);
    const DepthBounds found = bound_depth(pair, {});
    const double depth = -pair.bounds.lower;
    EXPECT_GT(found.lower, 0.0) << k;
    EXPECT_LE(found.lower, depth - 0.99 * 0x1p-49 * pair.size) << k;
    CurvedPair sampled(a, b, pose);
    for (int i = 0; i < 2000; ++i) (void)sampled.support(random.in_box(1.0).normalized());
    EXPECT_LE(found.lower, -sampled.bounds.lower) << k;
  }
}

}  // namespace
}  // namespace clearance
