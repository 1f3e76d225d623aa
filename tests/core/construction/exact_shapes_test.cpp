// Oracle: exact enumeration of all triples of rows or points (tests/shared/vertex_enumeration).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/core/construction/made_shapes.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance {
namespace {

using test::box_rows;
using test::expect_as_enumerated;
using test::made;
using test::refusal;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(ExactShapes, RowsOnALatticeGiveExactlyTheEnumeratedBody) {
  Random random(7);
  int accepted = 0;
  for (int round = 0; round < static_cast<int>(repeats(150)); ++round) {
    std::vector<HalfSpace> rows;
    const int count = random.integer(4, 14);
    for (int i = 0; i < count; ++i) {
      Vec3 normal = Vec3::Zero();
      while (normal.isZero(0.0)) {
        for (double& x : normal) x = random.integer(-2, 2);
      }
      rows.push_back({normal, static_cast<double>(random.integer(0, 3))});
    }
    const ShapeResult result = polyhedron_from_halfspaces(rows);
    const ConvexBody* body = std::get_if<ConvexBody>(&result);
    if (body == nullptr || body->vertices.empty()) continue;
    ++accepted;
    expect_as_enumerated(*body, rows);
    if (HasFailure()) FAIL() << "round " << round;
  }
  EXPECT_GT(accepted, static_cast<int>(repeats(80)));
}

TEST(ExactShapes, HardBodiesGiveExactlyTheEnumeratedBody) {
  Random random(11);
  for (int round = 0; round < static_cast<int>(repeats(40)); ++round) {
    std::vector<oracle::Body> bodies = {
        hard::random_polytope(random, random.integer(4, 16)),
        hard::with_duplicate_rows(hard::random_polytope(random, 8), random),
        hard::with_redundant_rows(hard::random_polytope(random, 8), random),
        hard::with_split_facets(hard::box({0.5, 0.25, 1.0}), random,
                                random.log_uniform(1e-15, 1e-3)),
        hard::with_scaled_rows(hard::random_polytope(random, 12), random),
        hard::shifted(hard::random_polytope(random, 8), random.in_box(1e6)),
        hard::scaled(hard::random_polytope(random, 8), random.log_uniform(1e-9, 1e9)),
        hard::unbounded(random),
        hard::facet_ball(2),
        hard::cone(random.integer(3, 14), 0.3, 1.0)};
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const std::vector<HalfSpace>& rows = bodies[i].rows;
      if (rows.empty() || rows.size() > 30) continue;
      const ConvexBody body = made(polyhedron_from_halfspaces(rows));
      if (body.vertices.empty()) {
        EXPECT_THAT(broken_invariants(body), IsEmpty());
      } else {
        expect_as_enumerated(body, rows);
      }
      if (HasFailure()) FAIL() << "round " << round << ", body " << i;
    }
  }
}

TEST(ExactShapes, PointsOnALatticeGiveExactlyTheEnumeratedHull) {
  Random random(13);
  for (int round = 0; round < 60; ++round) {
    std::vector<Vec3> points;
    const int count = random.integer(5, 14);
    for (int i = 0; i < count; ++i) {
      points.emplace_back(random.integer(0, 2), random.integer(0, 2), random.integer(0, 2));
    }
    const oracle::HullEnumeration truth = oracle::enumerate_hull(points);
    const ShapeResult result = polyhedron_from_vertices(points);
    const ConvexBody* body = std::get_if<ConvexBody>(&result);
    if (body == nullptr) {
      EXPECT_LT(truth.vertices.size(), 4U);
      continue;
    }
    EXPECT_THAT(broken_invariants(*body), IsEmpty());
    EXPECT_EQ(body->facets.size(), truth.facets.size());
    EXPECT_EQ(body->vertices.size(), truth.vertices.size());
    for (const Vertex& vertex : body->vertices) {
      EXPECT_TRUE(truth.vertices.contains(oracle::exact(vertex.position)));
    }
    if (HasFailure()) FAIL() << "round " << round;
  }
}

TEST(ExactShapes, ClustersNearOnePointKeepTheirExactHull) {
  Random random(17);
  for (int round = 0; round < 20; ++round) {
    std::vector<Vec3> points;
    for (int i = 0; i < 12; ++i) {
      // All points are within 1e-10 of (1, 1, 1): determinants in doubles have hardly a correct
      // digit.
      points.push_back(Vec3::Ones() + 0x1p-36 * Vec3(random.integer(-4, 4), random.integer(-4, 4),
                                                     random.integer(-4, 4)));
    }
    const oracle::HullEnumeration truth = oracle::enumerate_hull(points);
    const ConvexBody body = made(polyhedron_from_vertices(points));
    EXPECT_EQ(body.facets.size(), truth.facets.size());
    EXPECT_EQ(body.vertices.size(), truth.vertices.size());
    EXPECT_THAT(broken_invariants(body), IsEmpty());
  }
}

TEST(ExactShapes, ManyFacetsKeepEveryInvariant) {
  for (const int order : {4, 10, 30}) {
    const ConvexBody ball = made(polyhedron_from_halfspaces(hard::facet_ball(order).rows));
    EXPECT_THAT(broken_invariants(ball), IsEmpty());
    EXPECT_EQ(ball.facets.size(), hard::facet_ball(order).rows.size());
    const ConvexBody dual = made(polyhedron_from_vertices(hard::dual_ball(order).points));
    EXPECT_THAT(broken_invariants(dual), IsEmpty());
  }
}

TEST(ExactShapes, ScalingRepeatingAndReorderingRowsChangesNothing) {
  Random random(19);
  const std::vector<HalfSpace> rows = hard::random_polytope(random, 20).rows;
  std::vector<HalfSpace> worse(rows.rbegin(), rows.rend());
  for (HalfSpace& row : worse) {
    const double factor = std::ldexp(1.0, random.integer(-300, 300));
    row = {row.normal * factor, row.offset * factor};
  }
  worse.insert(worse.begin() + 7, rows.begin(), rows.end());
  const auto positions = [](const ConvexBody& body) {
    std::vector<std::array<double, 3>> result;
    for (const Vec3& a : body.anchors) result.push_back({a.x(), a.y(), a.z()});
    std::sort(result.begin(), result.end());
    return result;
  };
  const ConvexBody plain = made(polyhedron_from_halfspaces(rows));
  const ConvexBody repeated = made(polyhedron_from_halfspaces(worse));
  EXPECT_EQ(positions(plain), positions(repeated));
  EXPECT_EQ(plain.facets.size(), repeated.facets.size());
  EXPECT_EQ(plain.edges.size(), repeated.edges.size());
  EXPECT_EQ(plain.position_error, repeated.position_error);
}

TEST(ExactShapes, ShortEdgesKeepAccurateDirections) {
  // Four planes almost through (1, 1, 1). The top edge is 2^-56 long, below the spacing of doubles
  // at its ends, and must still run along x.
  const std::vector<HalfSpace> rows = {
      {{0, 1, 1}, 2}, {{0, -1, 1}, 0}, {{1, 0, 1}, 2}, {{-1, 0, 1}, 0x1p-56}, {{0, 0, -1}, 1}};
  const ConvexBody body = made(polyhedron_from_halfspaces(rows));
  EXPECT_THAT(broken_invariants(body), IsEmpty());
  const auto shortest =
      std::min_element(body.edges.begin(), body.edges.end(),
                       [](const Edge& a, const Edge& b) { return a.end < b.end; });
  ASSERT_NE(shortest, body.edges.end());
  EXPECT_EQ(shortest->end, 0x1p-56);
  EXPECT_EQ(shortest->direction.cwiseAbs(), Vec3(1, 0, 0));
  EXPECT_EQ(body.vertices[static_cast<std::size_t>(shortest->vertex[0])].position, Vec3::Ones());
  EXPECT_EQ(body.vertices[static_cast<std::size_t>(shortest->vertex[1])].position, Vec3::Ones());
}

TEST(ExactShapes, APlateThatIsTooThinIsToldFromOneUnitInTheLastPlaceLessThanNothing) {
  const double above = 1.0 + 0x1p-39;
  const double below = std::nextafter(1.0, 0.0);
  const ConvexBody plate = made(polyhedron_from_halfspaces(box_rows({-1, -1, 1.0}, {1, 1, above})));
  EXPECT_THAT(broken_invariants(plate), IsEmpty());
  EXPECT_EQ(plate.vertices.size(), 8U);
  EXPECT_EQ(plate.position_error, 0.0);
  EXPECT_EQ(refusal(polyhedron_from_halfspaces(
                box_rows({-1, -1, 1.0}, {1, 1, std::nextafter(1.0, 2.0)}))),
            "the body is thinner than 1e-12 m");
  EXPECT_EQ(
      refusal(polyhedron_from_halfspaces(box_rows({-1, -1, 1.0}, {1, 1, 1.0}))),
      "the half-spaces have no common interior: rows 3 and 6 leave only a flat piece between them");
  EXPECT_EQ(refusal(polyhedron_from_halfspaces(box_rows({-1, -1, 1.0}, {1, 1, below}))),
            "the half-spaces have no common point: rows 3 and 6 contradict each other");
}

TEST(ExactShapes, RowsNamedInARefusalAreAllNeeded) {
  Random random(23);
  int refused = 0;
  for (int round = 0; round < 200; ++round) {
    std::vector<HalfSpace> rows;
    for (int i = 0; i < 8; ++i) rows.push_back({random.direction(), random.uniform(-0.6, 0.6)});
    const std::string reason = refusal(polyhedron_from_halfspaces(rows));
    if (reason == "accepted") continue;
    ++refused;
    ASSERT_THAT(reason, HasSubstr("no common point: rows "));
    std::vector<HalfSpace> named;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (reason.find(" " + std::to_string(i + 1), reason.find("rows")) != std::string::npos) {
        named.push_back(rows[i]);
      }
    }
    ASSERT_THAT(refusal(polyhedron_from_halfspaces(named)), HasSubstr("no common point"));
    for (std::size_t i = 0; i < named.size(); ++i) {
      std::vector<HalfSpace> fewer = named;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
      EXPECT_EQ(refusal(polyhedron_from_halfspaces(fewer)), "accepted");
    }
  }
  EXPECT_GT(refused, 40);
}

}  // namespace
}  // namespace clearance
