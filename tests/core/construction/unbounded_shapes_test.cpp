// Oracles: closed forms, and exact enumeration of all triples of rows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/core/construction/made_shapes.hpp"

namespace clearance {
namespace {

using test::made;
using ::testing::IsEmpty;

TEST(UnboundedShapes, AreRefusedWhoseDirectionsAllButLieInOneLine) {
  const auto is_refused = [](const std::vector<HalfSpace>& rows) {
    const ShapeResult result = polyhedron_from_halfspaces(rows);
    const auto* error = std::get_if<ShapeError>(&result);
    return error != nullptr && error->reason.find("1e-6 rad") != std::string::npos;
  };
  for (const double angle : {1e-300, 1e-15, 0.9e-6}) {
    EXPECT_TRUE(is_refused({{{0, angle, 1}, 1}, {{0, 0, -1}, 1}})) << angle;
    EXPECT_TRUE(is_refused({{{0, angle, 1}, 1}, {{0, 0, 1}, 1}})) << angle;
  }
  for (const double angle : {0.0, 1e-6, 1.0}) {
    EXPECT_FALSE(is_refused({{{0, angle, 1}, 1}, {{0, 0, -1}, 1}})) << angle;
    EXPECT_FALSE(is_refused({{{0, angle, 1}, 1}, {{0, 0, 1}, 1}})) << angle;
  }
}

TEST(UnboundedShapes, HalfSpaceHasOneBarePlane) {
  const ConvexBody body =
      made(polyhedron_from_halfspaces(std::vector<HalfSpace>{{{0, 0, 2}, 5}, {{0, 0, 1}, 3}}));
  EXPECT_THAT(broken_invariants(body), IsEmpty());
  ASSERT_EQ(body.facets.size(), 1U);
  EXPECT_EQ(body.facets[0].offset, 2.5);
  EXPECT_EQ(body.facets[0].normal, Vec3(0, 0, 1));
  EXPECT_EQ(body.rays.size(), 5U);
  EXPECT_TRUE(
      std::all_of(body.rays.begin(), body.rays.end(), [](const Ray& r) { return r.exact; }));
  EXPECT_EQ(body.anchors, std::vector<Vec3>{Vec3(0, 0, 2.5)});
  EXPECT_LT(body.interior.z(), 2.5);
}

TEST(UnboundedShapes, SlabHasTwoBarePlanesAndTheirLines) {
  const std::vector<HalfSpace> rows = {{{1, 2, 2}, 9}, {{-2, -4, -4}, 9}, {{1, 2, 2}, 10}};
  const ConvexBody body = made(polyhedron_from_halfspaces(rows));
  EXPECT_THAT(broken_invariants(body), IsEmpty());
  ASSERT_EQ(body.facets.size(), 2U);
  EXPECT_EQ(body.facets[0].offset, 3.0);
  EXPECT_EQ(body.facets[1].offset, 1.5);
  EXPECT_EQ(body.rays.size(), 4U);
  EXPECT_TRUE(body.edges.empty());
  EXPECT_EQ(body.anchors[0], Vec3(1, 2, 2));
}

TEST(UnboundedShapes, SlabHasItsTightestPlanesInTheOrderOfTheirRows) {
  const std::vector<HalfSpace> rows = {{{1, 2, 2}, 9}, {{-2, -4, -4}, 9}, {{2, 4, 4}, 12}};
  const ConvexBody body = made(polyhedron_from_halfspaces(rows));
  EXPECT_THAT(broken_invariants(body), IsEmpty());
  ASSERT_EQ(body.facets.size(), 2U);
  EXPECT_EQ(body.facets[0].offset, 1.5);
  EXPECT_EQ(body.facets[1].offset, 2.0);
}

TEST(UnboundedShapes, WedgeHasOneFullLine) {
  const std::vector<HalfSpace> rows = {{{1, 1, 0}, 2}, {{-1, 1, 0}, 0}, {{0, 1, 0}, 7}};
  const ConvexBody body = made(polyhedron_from_halfspaces(rows));
  EXPECT_THAT(broken_invariants(body), IsEmpty());
  ASSERT_EQ(body.facets.size(), 2U);
  ASSERT_EQ(body.edges.size(), 1U);
  EXPECT_TRUE(body.vertices.empty());
  const Edge& line = body.edges[0];
  EXPECT_EQ(line.begin, -kInfinity);
  EXPECT_EQ(line.end, kInfinity);
  EXPECT_EQ(line.direction.cwiseAbs(), Vec3(0, 0, 1));
  EXPECT_EQ(line.point.head<2>(), Eigen::Vector2d(1, 1));
  EXPECT_EQ(body.rays.size(), 4U);
  for (const Ray& ray : body.rays) EXPECT_TRUE(ray.exact);
}

TEST(UnboundedShapes, UnboundedPrismHasALineForEachSide) {
  for (const int sides : {3, 4, 9}) {
    std::vector<HalfSpace> rows;
    for (int i = 0; i < sides; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / sides;
      rows.push_back({{std::cos(angle), std::sin(angle), 0.25 * std::sin(angle)}, 1.0});
    }
    const ConvexBody body = made(polyhedron_from_halfspaces(rows));
    EXPECT_THAT(broken_invariants(body), IsEmpty());
    EXPECT_EQ(body.facets.size(), static_cast<std::size_t>(sides));
    EXPECT_EQ(body.edges.size(), static_cast<std::size_t>(sides));
    EXPECT_EQ(body.rays.size(), 2U);
  }
}

TEST(UnboundedShapes, OctantHasThreeRaysFromOneCorner) {
  const ConvexBody body = made(polyhedron_from_halfspaces(
      std::vector<HalfSpace>{{{1, 0, 0}, 1}, {{0, 1, 0}, 2}, {{0, 0, 1}, 3}, {{1, 1, 1}, 6}}));
  EXPECT_THAT(broken_invariants(body), IsEmpty());
  EXPECT_EQ(body.facets.size(), 3U);
  ASSERT_EQ(body.vertices.size(), 1U);
  EXPECT_EQ(body.vertices[0].position, Vec3(1, 2, 3));
  for (const Edge& edge : body.edges) {
    EXPECT_EQ(edge.end, kInfinity);
    EXPECT_EQ(edge.direction.sum(), -1.0);
  }
}

TEST(UnboundedShapes, RecessionConesAreKnownOnceTheyAreMade) {
  const auto opening = [](const std::vector<HalfSpace>& rows) {
    const ConvexBody body = made(polyhedron_from_halfspaces(rows));
    EXPECT_EQ(
        std::count_if(body.rays.begin(), body.rays.end(), [](const Ray& r) { return !r.is_line; }),
        static_cast<std::ptrdiff_t>(body.recession_cone.rays.size()));
    return body.recession_cone;
  };
  const RecessionCone slab = opening({{{1, 2, 2}, 9}, {{-1, -2, -2}, 9}});
  EXPECT_EQ(slab.line_count, 2U);
  EXPECT_NEAR(slab.lines[0].dot(slab.lines[1]), 0.0, 1e-15);
  EXPECT_EQ(slab.inwards, Vec3(0, 0, 0));

  const RecessionCone wedge = opening({{{1, 1, 0}, 2}, {{-1, 1, 0}, 0}});
  EXPECT_EQ(wedge.line_count, 1U);
  EXPECT_EQ(wedge.lines[0].cwiseAbs(), Vec3(0, 0, 1));
  EXPECT_NEAR(wedge.least, std::sqrt(0.5), 1e-14);
  EXPECT_EQ(wedge.inwards, Vec3(0, -1, 0));

  const RecessionCone octant = opening({{{1, 0, 0}, 1}, {{0, 1, 0}, 2}, {{0, 0, 1}, 3}});
  EXPECT_EQ(octant.line_count, 0U);
  EXPECT_NEAR(octant.least, std::sqrt(1.0 / 3.0), 1e-14);
  EXPECT_LT(octant.least, std::sqrt(1.0 / 3.0));
}

}  // namespace
}  // namespace clearance
