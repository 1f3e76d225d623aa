// Oracles: closed forms, and the exact distance of tests/shared/exact_oracle.hpp.
#include "core/enclosing_polyhedron.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <variant>
#include <vector>

#include "core/shapes.hpp"
#include "tests/shared/body_group.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"

namespace clearance {
namespace {

using oracle::Body;
using test::boxes_apart;
using test::Group;
using test::random_group;

// The largest distance of the model's points from the only body in it. The distance from a body is
// convex, so its maximum is at a vertex.
double excess(const ConvexBody& model, const Group& group) {
  const ConvexBody probe = test::made(point(Vec3::Zero(), 0.0));
  const PlacedShape& body = group.placed.front();
  double farthest = 0.0;
  for (const Vertex& vertex : model.vertices) {
    const RelativePose at = relative_pose(body.frame_from_shape, Pose{.position = vertex.position});
    farthest = std::max(farthest, test::cold(*body.shape, probe, at).upper);
  }
  return farthest;
}

TEST(EnclosingPolyhedron, HoldsEveryPointOfTheBodiesExactly) {
  Random random(101);
  for (int round = 0; round < 20; ++round) {
    const Group group = random_group(random, random.integer(1, 5));
    const auto around = enclosing_polyhedron(group.placed);
    ASSERT_TRUE(around) << "round " << round;
    for (const Facet& facet : around->facets) {
      // No part of the bodies lies outside the facet by more than its rounding error.
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

// The vertices of the bodies are known to a millimetre only. Oracle: closed forms of support
// values.
TEST(EnclosingPolyhedron, HoldsBodiesWhereverTheirPositionErrorLetsThemBe) {
  constexpr double kError = 1e-3;
  const Vec3 half(0.3, 0.2, 0.1);
  ConvexBody solid = test::made(box(half)), round = test::made(cylinder(0.25, 0.5));
  solid.position_error = round.position_error = kError;
  Random random(103);
  for (int k = 0; k < 20; ++k) {
    const Pose place{random.in_box(1.0), random.rotation()};
    const Mat3 turned = place.orientation.toRotationMatrix();
    for (const ConvexBody* body : {&solid, &round}) {
      const PlacedShape placed{body, place};
      const auto around = enclosing_polyhedron({&placed, 1});
      ASSERT_TRUE(around);
      for (const Facet& facet : around->facets) {
        const Vec3 n = turned.transpose() * facet.normal;
        const double farthest = body == &solid
                                    ? n.cwiseAbs().dot(half)
                                    : 0.25 * std::hypot(n.x(), n.y()) + 0.5 * std::abs(n.z());
        EXPECT_GE(facet.offset, facet.normal.dot(place.position) + farthest + kError - 1e-14) << k;
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
  EXPECT_LT(excess(*around, group), 2e-3 * 4.0);  // the tolerance, relative to 4 m
  const auto tight = enclosing_polyhedron(group.placed, {.facets = 32, .tolerance = 1e-12});
  ASSERT_TRUE(tight);
  EXPECT_LT(excess(*tight, group), 1e-11);
}

TEST(EnclosingPolyhedron, MoreFacetsFitBetter) {
  Group group;
  group.add(hard::facet_ball(20), {});
  double before = kInfinity;
  for (const std::size_t facets : {6u, 12u, 24u, 48u, 96u}) {
    const auto around = enclosing_polyhedron(group.placed, {.facets = facets});
    ASSERT_TRUE(around);
    const double now = excess(*around, group);
    EXPECT_LT(now, before) << facets;
    before = now;
  }
  EXPECT_LT(before, 0.06);  // twice what the best 96 planes leave
}

// A solid has some thickness. Where doubles cannot tell it from the point there is no solid.
TEST(EnclosingPolyhedron, OfABarePointIsTheLeastSolidAroundIt) {
  for (const auto& [x, is_made] : {std::pair{0.0, true}, {0.75, true}, {1e12, false}}) {
    Group group;
    group.add({.rows = {}, .points = {{x, 0.0, 0.0}}}, {});
    const auto body = enclosing_polyhedron(group.placed);
    ASSERT_EQ(body.has_value(), is_made) << x;
    if (!is_made) continue;
    for (const Facet& facet : body->facets) {
      const double above = facet.offset - facet.normal.dot(Vec3(x, 0.0, 0.0));
      EXPECT_GT(above, 0.0) << x;
      EXPECT_LT(above, 1.1 * kLeastExtent) << x;
    }
  }
}

TEST(EnclosingPolyhedron, IsNotMadeOfNothingOrOfUnboundedBodies) {
  EXPECT_FALSE(enclosing_polyhedron({}));
  Group group = boxes_apart(1.0);
  group.add({.rows = {{Vec3::UnitZ(), 0.0}}, .points = {}}, {});
  EXPECT_FALSE(enclosing_polyhedron(group.placed));
}

}  // namespace
}  // namespace clearance
