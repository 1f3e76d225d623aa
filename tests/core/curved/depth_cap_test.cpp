// The cap of directions around the best one in which no direction has less depth. Oracle: the
// overlap along directions that are sampled in the cap.
#include "core/curved/depth_cap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/curved/thorough.hpp"
#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using test::at;
using test::made;

std::vector<ConvexBody> thick_bodies() {
  return {made(ellipsoid({0.6, 0.9, 1.4})), made(ellipsoid({1.0, 1.0, 0.3})),
          made(cylinder(0.5, 1.0)),         made(cone(1.0, 0.8)),
          made(truncated_cone(0.4, 1, 1)),  made(box({1.0, 0.7, 0.4}))};
}

constexpr double cover_tolerance(double size) { return 0x1p-49 * size; }

// The least overlap over directions in the cap that are sampled, the closest 1e-9 rad from n.
double least_in_cap(const CurvedPair& pair, const Vec3& n, double angle, Random& random) {
  const Vec3 x = n.unitOrthogonal(), y = n.cross(x);
  double least = kInfinity;
  for (int i = 0; i < 400; ++i) {
    const double f = i % 4 == 0 ? angle : angle * random.log_uniform(1e-9, 1.0);
    const double turn = random.uniform(0.0, 2.0 * std::numbers::pi);
    const Vec3 t = std::cos(turn) * x + std::sin(turn) * y;
    const Vec3 m = (std::cos(f) * n + std::sin(f) * t).normalized();
    least = std::min(least, -pair.support_along(m).value);
  }
  return least;
}

TEST(DepthCap, NoDirectionInItHasLessDepth) {
  const std::vector<ConvexBody> bodies = thick_bodies();
  Random random(71);
  int caps = 0, wide = 0;
  for (int k = 0; k < 600; ++k) {
    const ConvexBody& a = bodies[static_cast<std::size_t>(random.integer(0, 5))];
    const ConvexBody& b = bodies[static_cast<std::size_t>(random.integer(0, 4))];
    const RelativePose pose = relative_pose(Pose{}, random.pose(0.8));
    CurvedPair pair(a, b, pose);
    ActiveParts active;
    (void)search_direction(pair, random.direction(), active);
    const double depth = -pair.bounds.lower;
    if (!(depth > 1e-3)) continue;
    const Vec3 n = pair.bounds.normal;
    const double tolerance = cover_tolerance(pair.size);
    const DepthCap cap = depth_cap(pair, n, depth, tolerance, 0.0, active);
    caps += cap.angle > 0.0 ? 1 : 0;
    wide += cap.angle > 0.5 ? 1 : 0;
    EXPECT_GE(least_in_cap(pair, n, cap.angle, random), depth - 1.5 * tolerance) << k;
  }
  EXPECT_GT(caps, 300);
  EXPECT_GT(wide, 100);
}

// A hint that is wrong in part: parts of another direction, or one of two pairs that touch.
TEST(DepthCap, HoldsWhateverPartsAreActive) {
  const std::vector<ConvexBody> bodies = thick_bodies();
  Random random(73);
  for (int k = 0; k < 600; ++k) {
    const ConvexBody& a = bodies[static_cast<std::size_t>(random.integer(0, 5))];
    const ConvexBody& b = bodies[static_cast<std::size_t>(random.integer(0, 4))];
    const RelativePose pose = relative_pose(Pose{}, random.pose(0.8));
    CurvedPair pair(a, b, pose);
    ActiveParts active;
    if (k % 2 == 0) (void)search_direction(pair, random.direction(), active);
    const Vec3 n = k % 2 == 0 ? pair.bounds.normal : random.direction();
    const double depth = -pair.support(n).value;
    if (!(depth > 1e-3)) continue;
    active.count = static_cast<std::size_t>(random.integer(0, 3));
    for (PartPair& parts : active.pairs) {
      if (k % 2 == 0 && random.chance(0.7)) continue;
      parts = {random.integer(0, parts_of(a) - 1), random.integer(0, parts_of(b) - 1)};
    }
    for (PartPair& parts : active.pairs) {
      if (parts.a == kNone || parts.b == kNone) parts = {0, 0};
    }
    const double tolerance = cover_tolerance(pair.size);
    const DepthCap cap = depth_cap(pair, n, depth, tolerance, 0.0, active);
    EXPECT_GE(least_in_cap(pair, n, cap.angle, random), depth - 1.5 * tolerance) << k;
  }
}

// The face is much wider than the depth, so nearly all directions are in the cap.
TEST(DepthCap, IsNearlyTheSphereWhereAFlatFaceTouches) {
  const ConvexBody floor = made(box({5.0, 5.0, 0.5}));
  for (const ConvexBody& body : thick_bodies()) {
    if (!body.is_curved()) continue;
    const RelativePose pose = relative_pose(
        Pose{}, {Vec3(0.3, 0.1, 0.7),
                 Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Vec3(1.0, 0.4, 0.2).normalized()))});
    CurvedPair pair(floor, body, pose);
    ActiveParts active;
    (void)search_direction(pair, Vec3::UnitZ(), active);
    const double depth = -pair.bounds.lower;
    ASSERT_GT(depth, 0.0);
    const DepthCap cap =
        depth_cap(pair, pair.bounds.normal, depth, cover_tolerance(pair.size), 0.0, active);
    EXPECT_GT(cap.angle, 2.0);
  }
}

// A cover that had to refine its triangles towards the best direction would take hundreds.
TEST(DepthCap, SavesSupportPoints) {
  const ConvexBody floor = made(box({5.0, 5.0, 0.5}));
  const ConvexBody can = made(cylinder(0.2, 0.3));
  Random random(79);
  for (int k = 0; k < 50; ++k) {
    Pose pose = at(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.6);
    pose.orientation = random.rotation();
    TrackingState state;
    const DistanceResult first = distance(floor, can, at(0, 0, 0), pose, state);
    ASSERT_EQ(first.status, DistanceStatus::kOverlapping);
    EXPECT_LE(first.iterations, 60) << k;
    pose.position.x() += 1e-3;
    EXPECT_LE(distance(floor, can, at(0, 0, 0), pose, state).iterations, 30) << k;
  }
}

}  // namespace
}  // namespace clearance
