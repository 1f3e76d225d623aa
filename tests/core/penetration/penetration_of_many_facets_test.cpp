// The overlap depth of bodies that are too large for the exact oracle of depths.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/shapes.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"

namespace clearance {
namespace {

using test::cold;
using test::made;

// The size that the promised 1e-14 is relative to, with A at the origin.
double size_of(const ConvexBody& a, const ConvexBody& b, const Pose& pose_b) {
  return a.bounding_radius + a.radius + b.bounding_radius + b.radius + pose_b.position.norm();
}

TEST(Penetration, OfManyFacetsIsFoundToRoundingToo) {
  const ConvexBody a = made(hard::facet_ball(15)), b = made(hard::dual_ball(10));
  Random random(3);
  for (int k = 0; k < 20; ++k) {
    const Pose pose_b{random.direction() * random.uniform(0.0, 1.8), random.rotation()};
    const DistanceResult r = cold(a, b, pose_b);
    EXPECT_EQ(r.status, DistanceStatus::kOverlapping);
    EXPECT_LE(r.upper - r.lower, 1e-14 * size_of(a, b, pose_b));
  }
}

// The translation of B along n, of any length, after which it is clear of A.
double depth_along(const ConvexBody& a, const ConvexBody& b, const Pose& pose_b, const Vec3& n) {
  long double support_a = -kInfinity, support_b = -kInfinity;
  const auto along = [&](const Vec3& p) {
    return static_cast<long double>(n.x()) * p.x() + static_cast<long double>(n.y()) * p.y() +
           static_cast<long double>(n.z()) * p.z();
  };
  for (const Vertex& v : a.vertices) support_a = std::max(support_a, along(v.position));
  for (const Vertex& v : b.vertices) {
    support_b = std::max(support_b, -along(transform(pose_b, v.position)));
  }
  return static_cast<double>((support_a + support_b) / std::sqrt(along(n)));
}

// Each facet of the difference body is normal to a facet normal of one body's facet, or to an edge
// of each body. Any other direction needs a longer translation.
double shortest_path_out(const ConvexBody& a, const ConvexBody& b, const Pose& pose_b) {
  const Eigen::Quaterniond turn = pose_b.orientation.normalized();
  double least = kInfinity;
  const auto attempt = [&](const Vec3& n) {
    least = std::min(least, depth_along(a, b, pose_b, n));
  };
  for (const Facet& facet : a.facets) attempt(facet.normal);
  for (const Facet& facet : b.facets) attempt(-(turn * facet.normal));
  for (const Edge& e : a.edges) {
    for (const Edge& f : b.edges) {
      const Vec3 across = e.direction.cross(turn * f.direction);
      if (across.norm() < 1e-3) continue;
      attempt(across);
      attempt(-across);
    }
  }
  return least;
}

TEST(Penetration, IsTheLeastOverAllFacetsAndPairsOfEdges) {
  const ConvexBody a = made(hard::facet_ball(6)), b = made(hard::dual_ball(5));
  Random random(4);
  for (int k = 0; k < 8; ++k) {
    const Pose pose_b{random.direction() * random.uniform(0.0, 1.6), random.rotation()};
    EXPECT_NEAR(-cold(a, b, pose_b).distance, shortest_path_out(a, b, pose_b),
                1e-14 * size_of(a, b, pose_b));
  }
}

ConvexBody cylinder(int sides) {
  std::vector<Vec2> base;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    base.emplace_back(std::cos(angle), std::sin(angle));
  }
  return made(prism(base, -3.0, 3.0));
}

// Each quarter circle around the capsule's axis meets more vertices than the search examined per
// arc. The bounds once differed by 8e-5 of the size.
TEST(Penetration, OfACapsuleInACylinderOfManySidesIsFoundToRoundingToo) {
  constexpr int kSides = 9000;
  const ConvexBody b = cylinder(kSides);
  const ConvexBody capsule = made(segment({0.0, 0.0, -0.5}, {0.0, 0.0, 0.5}, 0.1));
  const DistanceResult r = cold(capsule, b, Pose{});
  EXPECT_NEAR(r.distance, -(std::cos(std::numbers::pi / kSides) + 0.1), 1e-13);
  EXPECT_LE(r.upper - r.lower, 1e-14 * size_of(capsule, b, Pose{}));
}

// The shortest separating translation is along x, where both bodies have an edge along z as their
// support feature.
TEST(Penetration, OfABoxInACylinderOfManySidesIsHowFarTheyReachAlongAnAxis) {
  const ConvexBody a = made(box({0.1, 0.1, 0.5})), b = cylinder(9000);
  const DistanceResult r = cold(a, b, Pose{});
  EXPECT_NEAR(r.distance, -1.1, 1e-14 * size_of(a, b, Pose{}));
  EXPECT_LE(r.upper - r.lower, 1e-14 * size_of(a, b, Pose{}));
}

}  // namespace
}  // namespace clearance
