// Oracles: closed forms.
#include "core/shapes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/core/construction/made_shapes.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using test::box_rows;
using test::made;
using test::refusal;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kMost = std::numeric_limits<double>::max();

TEST(Shapes, BoxIsExactInEveryNumber) {
  const ConvexBody body = made(box({0.1, 0.2, 0.3}));
  EXPECT_THAT(broken_invariants(body), IsEmpty());
  ASSERT_EQ(body.facets.size(), 6U);
  ASSERT_EQ(body.edges.size(), 12U);
  ASSERT_EQ(body.vertices.size(), 8U);
  EXPECT_EQ(body.position_error, 0.0);
  EXPECT_TRUE(body.bounded());
  for (const Facet& facet : body.facets) {
    EXPECT_EQ(facet.normal.cwiseAbs().sum(), 1.0);
    EXPECT_EQ(facet.offset, facet.normal.cwiseAbs().dot(Vec3(0.1, 0.2, 0.3)));
  }
  for (const Edge& edge : body.edges) {
    EXPECT_EQ(edge.end, edge.direction.cwiseAbs().dot(Vec3(0.2, 0.4, 0.6)));
  }
  for (const Vertex& vertex : body.vertices) {
    EXPECT_EQ(vertex.position.cwiseAbs(), Vec3(0.1, 0.2, 0.3));
  }
  EXPECT_NEAR(body.interior.norm(), 0.0, 1e-15);
}

TEST(Shapes, HalfSpacesAndVerticesOfABoxGiveTheSameBody) {
  const ConvexBody from_rows = made(polyhedron_from_halfspaces(box_rows({-1, -2, -3}, {4, 5, 6})));
  std::vector<Vec3> corners;
  for (const Vertex& vertex : from_rows.vertices) corners.push_back(vertex.position);
  const ConvexBody from_points = made(polyhedron_from_vertices(corners));
  EXPECT_EQ(from_points.facets.size(), 6U);
  EXPECT_EQ(from_rows.facets.size(), 6U);
  for (const Facet& facet : from_rows.facets) {
    EXPECT_TRUE(
        std::any_of(from_points.facets.begin(), from_points.facets.end(), [&](const Facet& other) {
          return other.normal == facet.normal && other.offset == facet.offset;
        }));
  }
}

TEST(Shapes, PrismTakesTheHullOfItsBase) {
  const std::vector<Vec2> base = {{0, 0}, {2, 0}, {1, 0}, {2, 2}, {1, 1}, {0, 2}, {2, 0}};
  const ConvexBody body = made(prism(base, -0.5, 1.5));
  EXPECT_THAT(broken_invariants(body), IsEmpty());
  EXPECT_EQ(body.facets.size(), 6U);
  EXPECT_EQ(body.vertices.size(), 8U);
  EXPECT_EQ(body.position_error, 0.0);
  EXPECT_TRUE(body.interior.isApprox(Vec3(1, 1, 0.5)));
}

TEST(Shapes, PointAndSegmentHaveNoFacets) {
  const ConvexBody sphere = made(point({1, 2, 2}, 0.25));
  EXPECT_THAT(broken_invariants(sphere), IsEmpty());
  EXPECT_EQ(sphere.radius, 0.25);
  EXPECT_GE(sphere.bounding_radius, 3.0);
  const ConvexBody capsule = made(segment({1, 1, 1}, {1, 4, 5}, 0.5));
  EXPECT_THAT(broken_invariants(capsule), IsEmpty());
  ASSERT_EQ(capsule.edges.size(), 1U);
  EXPECT_EQ(capsule.edges[0].end, 5.0);
  EXPECT_EQ(capsule.edges[0].direction, Vec3(0, 0.6, 0.8));
  EXPECT_EQ(capsule.position_error, 0.0);
}

TEST(Shapes, WhatIsNoSolidIsRefusedWithItsReason) {
  const auto rows_refused = [](std::vector<HalfSpace> rows) {
    return refusal(polyhedron_from_halfspaces(rows));
  };
  EXPECT_THAT(rows_refused({}), HasSubstr("no half-spaces"));
  EXPECT_THAT(rows_refused({{{1, 0, 0}, 1}, {{0, kNan, 0}, 1}}), HasSubstr("row 2"));
  EXPECT_THAT(rows_refused({{{1, 0, 0}, kInfinity}}), HasSubstr("row 1"));
  EXPECT_THAT(rows_refused({{{1, 0, 0}, 1}, {{0, 0, 0}, 1}}), HasSubstr("row 2 has a zero normal"));
  for (const double length : {1e-101, 1e101, 1e300}) {
    EXPECT_THAT(rows_refused({{{1, 0, 0}, 1}, {{length, 0, 0}, 0}}),
                HasSubstr("row 2 has a normal whose length is not from 1e-100 to 1e100"));
  }
  for (const double offset : {1.1e12, -1.1e12, kMost}) {
    EXPECT_THAT(rows_refused({{{1, 0, 0}, offset}}),
                HasSubstr("row 1 is a plane more than 1e12 m from the origin"));
  }
  EXPECT_THAT(rows_refused({{{1, 1e-3, 0}, 1e10}, {{-1, 1e-3, 0}, 1e10}}),
              HasSubstr("a vertex lies more than 1e12 m from the origin"));
  EXPECT_THAT(rows_refused({{{0, 0, 1}, 1}, {{0, 0, -1}, 1e-12 - 1}}), HasSubstr("thinner"));
  const auto points_refused = [](std::vector<Vec3> points) {
    return refusal(polyhedron_from_vertices(points));
  };
  EXPECT_THAT(points_refused({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), HasSubstr("at least four"));
  EXPECT_THAT(points_refused({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}),
              HasSubstr("in one plane"));
  EXPECT_THAT(points_refused({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}),
              HasSubstr("in one plane"));
  EXPECT_THAT(points_refused({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, kNan}}),
              HasSubstr("point 4"));
  EXPECT_THAT(points_refused({{0, 0, 0}, {1.1e12, 0, 0}, {0, 1, 0}, {1, 1, 1}}),
              HasSubstr("point 2 lies more than 1e12 m from the origin"));
  EXPECT_THAT(refusal(box({1, 0, 1})), HasSubstr("half extent y"));
  EXPECT_THAT(refusal(box({1, 1, -1})), HasSubstr("half extent z"));
  EXPECT_THAT(refusal(box({kInfinity, 1, 1})), HasSubstr("half extent x"));
  EXPECT_THAT(refusal(segment({1, 2, 3}, {1, 2, 3}, 0.1)), HasSubstr("the same point"));
  EXPECT_THAT(refusal(point({1, 2, kNan}, 0.1)), HasSubstr("not finite"));
  for (const double radius : {-0.1, kInfinity, kNan}) {
    EXPECT_THAT(refusal(point({1, 2, 3}, radius)), HasSubstr("radius is not a finite number"));
  }
  EXPECT_THAT(refusal(point({1, 2, 3}, 2e12)), HasSubstr("the radius is more than 1e12 m"));
  EXPECT_THAT(refusal(point({1, -2e12, 3}, 0.1)), HasSubstr("more than 1e12 m from the origin"));
  EXPECT_THAT(refusal(segment({1, 2, 3}, {1, 2, kMost}, 0.1)), HasSubstr("an end of the segment"));
  EXPECT_THAT(refusal(segment({1, 2, 3}, {1, 2, 4}, kMost)), HasSubstr("1e12 m"));
  EXPECT_THAT(refusal(segment({1, 2, 3}, {1, 2, 3 + 9e-13}, 0.1)), HasSubstr("shorter than 1e-12"));
  EXPECT_THAT(refusal(box({1, kMost, 1})), HasSubstr("1e12 m"));
  EXPECT_THAT(refusal(box({1, 4e-13, 1})), HasSubstr("thinner than 1e-12 m"));
  const std::vector<Vec2> line = {{0, 0}, {1, 1}, {2, 2}};
  EXPECT_THAT(refusal(prism(line, 0, 1)), HasSubstr("no area"));
  const std::vector<Vec2> triangle = {{0, 0}, {1, 0}, {0, 1}};
  for (const auto& [low, high] :
       {std::pair{1.0, 1.0}, {-kInfinity, 1.0}, {0.0, kInfinity}, {0.0, kNan}}) {
    EXPECT_THAT(refusal(prism(triangle, low, high)), HasSubstr("low end"));
  }
  EXPECT_THAT(refusal(prism(std::span(line).first(2), 0, 1)), HasSubstr("three points, found 2"));
  EXPECT_THAT(refusal(prism(std::vector<Vec2>{{0, 0}, {1, kNan}, {0, 1}}, 0, 1)),
              HasSubstr("base point 2 has a coordinate that is not finite"));
}

// The centre is a quotient of moments, which are products of four lengths.
TEST(Shapes, OfAnySizeHaveTheSameMiddle) {
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    const hard::Body hull = hard::random_hull(random, 12);
    const ConvexBody body = made(polyhedron_from_vertices(hull.points));
    for (const int exponent : {-27, -10, 20, 38}) {
      const double size = std::ldexp(1.0, exponent);
      std::vector<Vec3> points = hull.points;
      for (Vec3& point : points) point *= size;
      const ConvexBody scaled = made(polyhedron_from_vertices(points));
      EXPECT_THAT(broken_invariants(scaled), IsEmpty()) << exponent;
      EXPECT_EQ(scaled.interior, size * body.interior) << exponent;
      EXPECT_EQ(scaled.inner_radius, size * body.inner_radius) << exponent;
    }
  }
}

// The corners of the sheet are rounded by ten times its thickness.
TEST(Shapes, ASheetThinnerThanTheRoundingOfItsCornersHasAMiddleInItToThatRounding) {
  for (const double thin : {3e-11, 1e-10, 3e-9}) {
    const ConvexBody sheet =
        made(polyhedron_from_halfspaces(std::vector<HalfSpace>{{{1, 2, 2}, 0},
                                                               {{-1, -2, -2}, thin},
                                                               {{0, 1, 0}, 1e6 + 1},
                                                               {{0, -1, 0}, -1e6},
                                                               {{0, 0, 1}, 1e6 + 1},
                                                               {{0, 0, -1}, -1e6}}));
    EXPECT_NEAR(sheet.interior.dot(Vec3(1, 2, 2)), -0.5 * thin, 0.5 * thin + 1e-8);
    EXPECT_NEAR(sheet.interior.y(), 1e6 + 0.5, 0.5);
    EXPECT_NEAR(sheet.interior.z(), 1e6 + 0.5, 0.5);
  }
}

TEST(Shapes, TheSameInputGivesTheSameBits) {
  Random random(29);
  const std::vector<HalfSpace> rows = hard::random_polytope(random, 40).rows;
  const ConvexBody first = made(polyhedron_from_halfspaces(rows));
  const ConvexBody second = made(polyhedron_from_halfspaces(rows));
  EXPECT_EQ(first.anchors, second.anchors);
  ASSERT_EQ(first.edges.size(), second.edges.size());
  for (std::size_t e = 0; e < first.edges.size(); ++e) {
    EXPECT_EQ(first.edges[e].direction, second.edges[e].direction);
    EXPECT_EQ(first.edges[e].end, second.edges[e].end);
  }
}

TEST(PolyhedronInvariants, NoticeEveryKindOfDamage) {
  const ConvexBody whole = made(box({1, 2, 3}));
  ASSERT_THAT(broken_invariants(whole), IsEmpty());
  const auto damaged = [&whole](auto damage) {
    ConvexBody body = whole;
    damage(body);
    return broken_invariants(body);
  };
  EXPECT_THAT(damaged([](auto& b) { b.facets[2].offset += 1e-9; }), Not(IsEmpty()));
  EXPECT_THAT(damaged([](auto& b) { b.facets[2].normal *= 1.0 + 1e-9; }), Not(IsEmpty()));
  EXPECT_THAT(damaged([](auto& b) { b.edges[3].end += 1e-9; }), Not(IsEmpty()));
  EXPECT_THAT(damaged([](auto& b) { b.edges[3].inward.row(1) *= -1.0; }), Not(IsEmpty()));
  EXPECT_THAT(damaged([](auto& b) { std::swap(b.edges[3].facet[0], b.edges[3].facet[1]); }),
              Not(IsEmpty()));
  EXPECT_THAT(damaged([](auto& b) { std::swap(b.facet_edges[0], b.facet_edges[1]); }),
              Not(IsEmpty()));
  EXPECT_THAT(damaged([](auto& b) { std::swap(b.vertex_edges[0], b.vertex_edges[1]); }),
              Not(IsEmpty()));
  EXPECT_THAT(damaged([](auto& b) { b.vertices[4].position *= 1.0 + 1e-9; }), Not(IsEmpty()));
  EXPECT_THAT(damaged([](auto& b) { b.anchors.pop_back(); }), Not(IsEmpty()));
  EXPECT_THAT(damaged([](auto& b) { b.rays.push_back({Vec3(1, 0, 0), true}); }), Not(IsEmpty()));
  EXPECT_THAT(damaged([](auto& b) { b.bounding_radius *= 0.99; }), Not(IsEmpty()));
  EXPECT_THAT(damaged([](auto& b) { b.interior = Vec3(5, 0, 0); }), Not(IsEmpty()));
  EXPECT_THAT(damaged([](auto& b) { b.facets.pop_back(); }), Not(IsEmpty()));
}

}  // namespace
}  // namespace clearance
