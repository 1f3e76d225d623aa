// Oracles: closed forms, and the exact distance of tests/shared/exact_oracle.hpp.
#include "core/enclosing_polyhedron.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <variant>
#include <vector>

#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"

namespace clearance {
namespace {

using oracle::Body;

// Some bodies in one frame, for the core and for the oracle.
struct Group {
  std::vector<Body> bodies;
  std::vector<ConvexBody> shapes;
  std::vector<PlacedShape> placed;

  void add(const Body& body, const Pose& pose) {
    bodies.push_back(body);
    shapes.push_back(test::made(body));
    placed.push_back({nullptr, pose});
    for (std::size_t i = 0; i < shapes.size(); ++i) placed[i].shape = &shapes[i];
  }

  [[nodiscard]] double exact_distance_from(const Vec3& position) const {
    const Body probe{.rows = {}, .points = {position}};
    double nearest = kInfinity;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      nearest = std::min(
          nearest,
          oracle::exact_distance(probe, Pose{}, bodies[i], placed[i].frame_from_shape).lower);
    }
    return nearest;
  }
};

Group random_group(Random& random, int count) {
  Group group;
  for (int i = 0; i < count; ++i) {
    const Body body = random.chance(0.3) ? hard::rounded(random) : hard::any_bounded(random);
    group.add(body, {random.in_box(2.0),
                     random.chance(0.3) ? Eigen::Quaterniond::Identity() : random.rotation()});
  }
  return group;
}

Group boxes_apart(double gap) {
  Group group;
  const Body box = hard::box({0.5, 0.5, 0.5});
  group.add(box, {});
  group.add(box, {.position = Vec3(1.0 + gap, 0.0, 0.0)});
  return group;
}

TEST(EnclosingPolyhedron, HoldsEveryPointOfTheBodiesExactly) {
  Random random(101);
  for (int round = 0; round < 20; ++round) {
    const Group group = random_group(random, random.integer(1, 5));
    const auto around = enclosing_polyhedron(group.placed);
    ASSERT_TRUE(around) << "round " << round;
    for (const Facet& facet : around->facets) {
      // Beyond the facet, and what rounding may have moved it, there is nothing of the bodies.
      const double moved = around->position_error + 0x1p-50 * around->bounding_radius;
      const Body beyond{.rows = {{-facet.normal, -(facet.offset + moved)}}, .points = {}};
      for (std::size_t i = 0; i < group.bodies.size(); ++i) {
        const auto apart = oracle::exact_distance(beyond, Pose{}, group.bodies[i],
                                                  group.placed[i].frame_from_shape);
        EXPECT_FALSE(apart.cores_meet()) << "round " << round << ", body " << i;
        EXPECT_GT(apart.compare(0.0), 0) << "round " << round << ", body " << i;
      }
    }
  }
}

TEST(EnclosingPolyhedron, HasNoMoreFacetsThanAskedFor) {
  Random random(102);
  for (const std::size_t facets : {6u, 12u, 32u}) {
    for (int round = 0; round < 20; ++round) {
      const Group group = random_group(random, random.integer(1, 4));
      const auto around = enclosing_polyhedron(group.placed, {.facets = facets});
      ASSERT_TRUE(around);
      EXPECT_LE(around->facets.size(), facets);
      EXPECT_TRUE(around->bounded());
    }
  }
}

TEST(EnclosingPolyhedron, OfABodyWithFewFacetsIsThatBody) {
  Group group;
  group.add(hard::box({0.3, 0.2, 0.1}), {Vec3(1, 2, 3), Eigen::Quaterniond(0.8, 0.2, 0.4, 0.4)});
  const auto around = enclosing_polyhedron(group.placed);
  ASSERT_TRUE(around);
  EXPECT_LT(excess(*around, group.placed), 2e-3 * 4.0);  // the tolerance, of 4 m
  const auto tight = enclosing_polyhedron(group.placed, {.facets = 32, .tolerance = 1e-12});
  ASSERT_TRUE(tight);
  EXPECT_LT(excess(*tight, group.placed), 1e-11);
}

TEST(EnclosingPolyhedron, MoreFacetsFitBetter) {
  Group group;
  group.add(hard::facet_ball(20), {});
  double before = kInfinity;
  for (const std::size_t facets : {6u, 12u, 24u, 48u, 96u}) {
    const auto around = enclosing_polyhedron(group.placed, {.facets = facets});
    ASSERT_TRUE(around);
    const double now = excess(*around, group.placed);
    EXPECT_LT(now, before) << facets;
    before = now;
  }
  EXPECT_LT(before, 0.06);  // twice what the best 96 planes leave
}

TEST(EnclosingPolyhedron, IsNotMadeOfNothingOrOfUnboundedBodies) {
  EXPECT_FALSE(enclosing_polyhedron({}));
  Group group = boxes_apart(1.0);
  group.add({.rows = {{Vec3::UnitZ(), 0.0}}, .points = {}}, {});
  EXPECT_FALSE(enclosing_polyhedron(group.placed));
}

TEST(Excess, OfTheCubeAroundASphereIsAtItsCorners) {
  Group group;
  group.add({.rows = {}, .points = {Vec3(1, 2, 3)}, .radius = 0.5}, {});
  const auto cube = enclosing_polyhedron(group.placed, {.facets = 6});
  ASSERT_TRUE(cube);
  EXPECT_NEAR(excess(*cube, group.placed), 0.5 * (std::sqrt(3.0) - 1.0), 1e-12);
}

TEST(Excess, BetweenTwoBodiesCounts) {
  const Group group = boxes_apart(2.0);
  const auto around = enclosing_polyhedron(group.placed);
  ASSERT_TRUE(around);
  const double found = excess(*around, group.placed);
  EXPECT_GE(found, 1.0);  // halfway between
  EXPECT_LE(found, 1.0 / 0.98);
}

TEST(Excess, OfOneBodyIsReachedAtACorner) {
  Random random(103);
  for (int round = 0; round < 25; ++round) {
    const Group group = random_group(random, 1);
    const auto around = enclosing_polyhedron(group.placed, {.facets = 12});
    ASSERT_TRUE(around);
    double farthest = 0.0;
    for (const Vertex& v : around->vertices) {
      farthest = std::max(farthest, group.exact_distance_from(v.position));
    }
    const double found = excess(*around, group.placed);
    EXPECT_GE(found, farthest) << "round " << round;
    EXPECT_LE(found, farthest + 1e-12) << "round " << round;
  }
}

TEST(Excess, NoPointOfTheModelIsFartherFromTheNearestBody) {
  Random random(104);
  for (int round = 0; round < 25; ++round) {
    const Group group = random_group(random, random.integer(2, 4));
    const auto around = enclosing_polyhedron(group.placed, {.facets = 16});
    ASSERT_TRUE(around);
    const double found = excess(*around, group.placed);
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

TEST(Excess, OfABallIsExactForOneBody) {
  Group group;
  group.add(hard::box({1.0, 0.5, 0.25}), {});
  const double radius = Vec3(1.0, 0.5, 0.25).norm();
  EXPECT_NEAR(excess_of_sphere(Vec3::Zero(), radius, group.placed), radius - 0.25, 1e-12);
  EXPECT_NEAR(excess_of_sphere(Vec3(0, 0, 1.25), 2.5, group.placed), 3.5, 1e-12);
}

}  // namespace
}  // namespace clearance
