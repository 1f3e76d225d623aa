// Oracles: closed forms, and the exact distance of tests/shared/exact_oracle.hpp.
#include "tools/scene/certified_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/shapes.hpp"
#include "tests/shared/body_group.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using test::boxes_apart;
using test::Group;
using test::random_group;

double error_of_ball(const Vec3& centre, double radius, const Group& group) {
  const ConvexBody ball = test::made(point(Vec3::Zero(), radius));
  return certified_error(ball, Pose{.position = centre}, group.placed);
}

TEST(CertifiedError, OfTheCubeAroundASphereIsAtItsVertices) {
  Group group;
  group.add({.rows = {}, .points = {Vec3(1, 2, 3)}, .radius = 0.5}, {});
  const auto cube = enclosing_polyhedron(group.placed, {.facets = 6});
  ASSERT_TRUE(cube);
  EXPECT_NEAR(certified_error(*cube, Pose{}, group.placed), 0.5 * (std::sqrt(3.0) - 1.0), 1e-12);
}

TEST(CertifiedError, CountsPointsBetweenTwoBodies) {
  const Group group = boxes_apart(2.0);
  const auto around = enclosing_polyhedron(group.placed);
  ASSERT_TRUE(around);
  const double found = certified_error(*around, Pose{}, group.placed);
  EXPECT_GE(found, 1.0);  // halfway between the two
  EXPECT_LE(found, 1.0 / 0.98);
}

// A thin bar past two balls. The point halfway between these is none of the points that a split
// tries, so that the greatest distance tried is less than the truth.
TEST(CertifiedError, IsNotOnlyWhatTheTriedPointsReach) {
  Group group;
  group.add({.rows = {}, .points = {Vec3(0, 0, 0)}, .radius = 0.05}, {});
  group.add({.rows = {}, .points = {Vec3(1, 0, 0)}, .radius = 0.05}, {});
  const ConvexBody bar = test::made(box({0.535, 1e-6, 1e-6}));
  const double found = certified_error(bar, Pose{.position = Vec3(0.435, 0, 0)}, group.placed);
  EXPECT_GE(found, 0.45);
  EXPECT_LE(found, 0.55);  // splitting a thin bar ends at its limit
}

TEST(CertifiedError, OfOneBodyIsReachedAtAVertex) {
  Random random(103);
  for (int round = 0; round < 25; ++round) {
    const Group group = random_group(random, 1);
    const auto around = enclosing_polyhedron(group.placed, {.facets = 12});
    ASSERT_TRUE(around);
    double farthest = 0.0;
    for (const Vertex& v : around->vertices) {
      farthest = std::max(farthest, group.exact_distance_from(v.position));
    }
    const double found = certified_error(*around, Pose{}, group.placed);
    EXPECT_GE(found, farthest) << "round " << round;
    EXPECT_LE(found, farthest + 1e-12) << "round " << round;
  }
}

TEST(CertifiedError, BoundsTheDistanceOfEveryPointFromTheNearestBody) {
  Random random(104);
  for (int round = 0; round < 25; ++round) {
    const Group group = random_group(random, random.integer(2, 4));
    const auto around = enclosing_polyhedron(group.placed, {.facets = 16});
    ASSERT_TRUE(around);
    const double found = certified_error(*around, Pose{}, group.placed);
    for (int i = 0; i < 40; ++i) {
      Vec3 sum = Vec3::Zero();
      double weights = 0.0;
      for (const Vertex& v : around->vertices) {
        const double weight = std::pow(random.unit(), 4.0);
        sum += weight * v.position;
        weights += weight;
      }
      EXPECT_LE(group.exact_distance_from(sum / weights), found) << "round " << round;
    }
  }
}

TEST(CertifiedError, OfABallIsExactForOneBody) {
  Group group;
  group.add(hard::box({1.0, 0.5, 0.25}), {});
  const double radius = Vec3(1.0, 0.5, 0.25).norm();
  EXPECT_NEAR(error_of_ball(Vec3::Zero(), radius, group), radius - 0.25, 1e-12);
  EXPECT_NEAR(error_of_ball(Vec3(0, 0, 1.25), 2.5, group), 3.5, 1e-12);
}

// The oracle is the support function of a polyhedron around curved bodies, whose vertices are
// sampled on their surface.
TEST(CertifiedError, HoldsForCurvedBodies) {
  const ConvexBody bodies[] = {test::made(ellipsoid({0.5, 0.3, 0.2})),
                               test::made(cylinder(0.3, 0.4)),
                               test::made(truncated_cone(0.4, 0.1, 0.3))};
  Random random(105);
  for (int round = 0; round < 10; ++round) {
    std::vector<PlacedShape> placed;
    for (const ConvexBody& body : bodies) placed.push_back({&body, random.pose(0.5)});
    const auto around = enclosing_polyhedron(placed);
    ASSERT_TRUE(around);
    const double found = certified_error(*around, Pose{}, placed);
    EXPECT_LT(found, 0.6);
    const ConvexBody probe = test::made(point(Vec3::Zero(), 0.0));
    for (const Vertex& v : around->vertices) {
      double nearest = kInfinity;
      for (const PlacedShape& body : placed) {
        const RelativePose at = relative_pose(body.frame_from_shape, Pose{.position = v.position});
        nearest = std::min(nearest, test::cold(*body.shape, probe, at).lower);
      }
      EXPECT_LE(nearest, found) << "round " << round;
    }
  }
}

}  // namespace
}  // namespace clearance
