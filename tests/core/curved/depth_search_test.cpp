// The depth that the cover of all directions certifies, before rounding errors widen it. Oracle:
// the least overlap over directions that are sampled, which is never below the depth.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/curved/thorough.hpp"
#include "core/distance.hpp"
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

// A cone's cap lies almost flat on a cylinder's. The best direction that a search finds is then
// near an axis, and the overlap along the axis itself may be less. Oracle: the overlap along both
// axes.
TEST(DepthSearch, NeverCertifiesMoreThanTheOverlapAlongAnAxis) {
  Random random(97);
  const auto extent = [&] { return random.log_uniform(0.01, 0.5); };
  for (int k = 0; k < 500; ++k) {
    const ConvexBody a = test::made(cone(extent(), extent()));
    const ConvexBody b = test::made(cylinder(extent(), extent()));
    const double depth = random.log_uniform(1e-10, 1e-3);
    const double level = a.curved.discs[1].height + b.curved.discs[1].height;
    const double tilt = random.log_uniform(1e-14, 1e-4);
    Pose place{Vec3(random.uniform(-1e-2, 1e-2), random.uniform(-1e-2, 1e-2), level - depth),
               Eigen::Quaterniond(Eigen::AngleAxisd(tilt, random.direction()))};
    TrackingState state;
    for (int step = 0; step < 3; ++step) {
      const RelativePose pose = relative_pose(Pose{}, place);
      const DistanceResult r = distance(a, b, pose, state);
      const CurvedPair pair(a, b, pose);
      for (const Vec3& axis : {Vec3(Vec3::UnitZ()), Vec3(pose.rotation.col(2).normalized())}) {
        for (const double sign : {1.0, -1.0}) {
          const double overlap = -pair.support_along(sign * axis).value;
          EXPECT_LE(-r.upper, overlap + 1e-14 * pair.size) << k << ' ' << step;
        }
      }
      place.position += Vec3(1e-6, 0.0, -1e-3 * depth);
    }
  }
}

// In 2 of 100 of these pairs, a direction beside the search was better than where it ended, and the
// points were those of no direction: up to 0.1 m off. Oracle: the depth, which the bounds prove.
TEST(DepthSearch, DeepestPointsAreAsFarApartAlongTheNormalAsTheBodiesAreDeep) {
  int overlaps = 0;
  for (const ConvexBody& a :
       {test::made(cylinder(0.1, 0.3)), test::made(ellipsoid({0.3, 0.2, 0.1})),
        test::made(truncated_cone(0.15, 0.08, 0.2))}) {
    for (int seed = 0; seed < 600; ++seed) {
      Random random(static_cast<std::uint64_t>(seed) * 7919 + 13);
      Vec3 half;
      for (int k = 0; k < 3; ++k) half[k] = random.log_uniform(0.002, 0.1);
      const ConvexBody b = test::made(box(half));
      TrackingState state;
      const DistanceResult r = distance(a, b, relative_pose(Pose{}, random.pose(0.15)), state);
      if (r.status != DistanceStatus::kOverlapping) continue;
      ++overlaps;
      EXPECT_NEAR((r.point_on_b - r.point_on_a).dot(r.normal), r.distance, 1e-11) << seed;
    }
  }
  EXPECT_GT(overlaps, 900);
}

}  // namespace
}  // namespace clearance
