// Oracles: closed forms; exact enumeration of all triples of rows or points
// (tests/shared/vertex_enumeration).
#include "core/shapes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/polyhedron_invariants.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/vertex_enumeration.hpp"

namespace clearance {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

ConvexPolyhedron made(const ShapeResult& result) {
  const ShapeError* error = std::get_if<ShapeError>(&result);
  EXPECT_EQ(error, nullptr) << error->reason;
  return error == nullptr ? std::get<ConvexPolyhedron>(result) : ConvexPolyhedron{};
}

std::string refusal(const ShapeResult& result) {
  const ShapeError* error = std::get_if<ShapeError>(&result);
  return error == nullptr ? "accepted" : error->reason;
}

std::vector<HalfSpace> box_rows(const Vec3& low, const Vec3& high) {
  return {{{1, 0, 0}, high.x()},  {{0, 1, 0}, high.y()},  {{0, 0, 1}, high.z()},
          {{-1, 0, 0}, -low.x()}, {{0, -1, 0}, -low.y()}, {{0, 0, -1}, -low.z()}};
}

bool points_along(const Vec3& direction, const oracle::IntegerVec& ray, bool exact) {
  if (exact) {
    const oracle::IntegerVec found = oracle::primitive(oracle::exact(direction));
    return found == ray;
  }
  const Vec3 wanted(ray[0].get_d(), ray[1].get_d(), ray[2].get_d());
  return (direction - wanted.normalized()).norm() <= 0x1p-51;
}

using oracle::Rational;

// x |x| grows with x and turns square roots into fractions.
Rational signed_square(const Rational& x) { return x * abs(x); }

// Is the square root with the sign of `square` within `error` of `rounded`?
bool is_root_within(double rounded, double error, const Rational& square) {
  return signed_square(Rational(rounded) - Rational(error)) <= square &&
         square <= signed_square(Rational(rounded) + Rational(error));
}

Rational squared_distance(const oracle::RationalVec& a, const oracle::RationalVec& b) {
  Rational sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

// position_error bounds what rounding did to anchors, offsets and edge ends.
void expect_error_is_bounded(const ConvexPolyhedron& body, const oracle::Enumeration& truth) {
  const Rational allowed = Rational(body.position_error) * Rational(body.position_error);
  std::vector<oracle::RationalVec> exact;
  for (const Vertex& vertex : body.vertices) {
    for (const oracle::RationalVec& candidate : truth.vertices) {
      if (!oracle::is_nearest(vertex.position, candidate)) continue;
      EXPECT_LE(squared_distance(oracle::exact(vertex.position), candidate), allowed);
      exact.push_back(candidate);
    }
  }
  for (const Facet& facet : body.facets) {
    EXPECT_TRUE(std::any_of(truth.facets.begin(), truth.facets.end(), [&](const auto& plane) {
      const oracle::IntegerVec normal = {plane[0], plane[1], plane[2]};
      Rational square(plane[3] * abs(plane[3]),
                      normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
      square.canonicalize();
      return points_along(facet.normal, normal, false) &&
             is_root_within(facet.offset, body.position_error, square);
    })) << "no half-space has a facet's normal and offset";
  }
  if (exact.size() != body.vertices.size()) return;  // two vertices round to one point
  for (const Edge& edge : body.edges) {
    if (edge.vertex[1] == kNone) continue;
    const Rational square = squared_distance(exact[static_cast<std::size_t>(edge.vertex[0])],
                                             exact[static_cast<std::size_t>(edge.vertex[1])]);
    EXPECT_TRUE(is_root_within(edge.end, body.position_error, square));
  }
}

// Same vertices (each rounded once), same rays, as many facets.
void expect_as_enumerated(const ConvexPolyhedron& body, std::span<const HalfSpace> rows) {
  const oracle::Enumeration truth = oracle::enumerate(rows);
  EXPECT_EQ(body.vertices.size(), truth.vertices.size());
  EXPECT_EQ(body.rays.size(), truth.rays.size());
  EXPECT_EQ(body.facets.size(), truth.facets.size());
  for (const oracle::RationalVec& vertex : truth.vertices) {
    EXPECT_TRUE(
        std::any_of(body.vertices.begin(), body.vertices.end(),
                    [&](const Vertex& v) { return oracle::is_nearest(v.position, vertex); }))
        << "no vertex near " << vertex[0].get_d() << ' ' << vertex[1].get_d() << ' '
        << vertex[2].get_d();
  }
  for (const oracle::IntegerVec& ray : truth.rays) {
    EXPECT_TRUE(std::any_of(body.rays.begin(), body.rays.end(),
                            [&](const Ray& r) { return points_along(r.direction, ray, r.exact); }));
  }
  expect_error_is_bounded(body, truth);
  EXPECT_THAT(broken_invariants(body), IsEmpty());
}

TEST(Shapes, BoxIsExactInEveryNumber) {
  const ConvexPolyhedron body = made(box({0.1, 0.2, 0.3}));
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
  const ConvexPolyhedron from_rows =
      made(polyhedron_from_halfspaces(box_rows({-1, -2, -3}, {4, 5, 6})));
  std::vector<Vec3> corners;
  for (const Vertex& vertex : from_rows.vertices) corners.push_back(vertex.position);
  const ConvexPolyhedron from_points = made(polyhedron_from_vertices(corners));
  EXPECT_EQ(from_points.facets.size(), 6U);
  EXPECT_EQ(from_rows.facets.size(), 6U);
  for (const Facet& facet : from_rows.facets) {
    EXPECT_TRUE(
        std::any_of(from_points.facets.begin(), from_points.facets.end(), [&](const Facet& other) {
          return other.normal == facet.normal && other.offset == facet.offset;
        }));
  }
}

TEST(Shapes, RowsOnALatticeGiveExactlyTheEnumeratedBody) {
  Random random(7);
  int accepted = 0;
  for (int round = 0; round < 150; ++round) {
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
    const ConvexPolyhedron* body = std::get_if<ConvexPolyhedron>(&result);
    if (body == nullptr || body->vertices.empty()) continue;
    ++accepted;
    expect_as_enumerated(*body, rows);
    if (HasFailure()) FAIL() << "round " << round;
  }
  EXPECT_GT(accepted, 80);
}

TEST(Shapes, HardBodiesGiveExactlyTheEnumeratedBody) {
  Random random(11);
  for (int round = 0; round < 40; ++round) {
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
      const ConvexPolyhedron body = made(polyhedron_from_halfspaces(rows));
      if (body.vertices.empty()) {
        EXPECT_THAT(broken_invariants(body), IsEmpty());
      } else {
        expect_as_enumerated(body, rows);
      }
      if (HasFailure()) FAIL() << "round " << round << ", body " << i;
    }
  }
}

TEST(Shapes, PointsOnALatticeGiveExactlyTheEnumeratedHull) {
  Random random(13);
  for (int round = 0; round < 60; ++round) {
    std::vector<Vec3> points;
    const int count = random.integer(5, 14);
    for (int i = 0; i < count; ++i) {
      points.emplace_back(random.integer(0, 2), random.integer(0, 2), random.integer(0, 2));
    }
    const oracle::HullEnumeration truth = oracle::enumerate_hull(points);
    const ShapeResult result = polyhedron_from_vertices(points);
    const ConvexPolyhedron* body = std::get_if<ConvexPolyhedron>(&result);
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

TEST(Shapes, ClustersNearOnePointKeepTheirExactHull) {
  Random random(17);
  for (int round = 0; round < 20; ++round) {
    std::vector<Vec3> points;
    for (int i = 0; i < 12; ++i) {
      // A few units in the last place around (1, 1, 1): no determinant in doubles has a correct
      // digit.
      points.push_back(Vec3::Ones() + 0x1p-52 * Vec3(random.integer(-4, 4), random.integer(-4, 4),
                                                     random.integer(-4, 4)));
    }
    const oracle::HullEnumeration truth = oracle::enumerate_hull(points);
    const ConvexPolyhedron body = made(polyhedron_from_vertices(points));
    EXPECT_EQ(body.facets.size(), truth.facets.size());
    EXPECT_EQ(body.vertices.size(), truth.vertices.size());
    EXPECT_THAT(broken_invariants(body), IsEmpty());
  }
}

TEST(Shapes, ManyFacetsKeepEveryInvariant) {
  for (const int order : {4, 10, 30}) {
    const ConvexPolyhedron ball = made(polyhedron_from_halfspaces(hard::facet_ball(order).rows));
    EXPECT_THAT(broken_invariants(ball), IsEmpty());
    EXPECT_EQ(ball.facets.size(), hard::facet_ball(order).rows.size());
    const ConvexPolyhedron dual = made(polyhedron_from_vertices(hard::dual_ball(order).points));
    EXPECT_THAT(broken_invariants(dual), IsEmpty());
  }
}

TEST(Shapes, ScalingRepeatingAndReorderingRowsChangesNothing) {
  Random random(19);
  const std::vector<HalfSpace> rows = hard::random_polytope(random, 20).rows;
  std::vector<HalfSpace> worse(rows.rbegin(), rows.rend());
  for (HalfSpace& row : worse) {
    const double factor = std::ldexp(1.0, random.integer(-300, 300));
    row = {row.normal * factor, row.offset * factor};
  }
  worse.insert(worse.begin() + 7, rows.begin(), rows.end());
  const auto positions = [](const ConvexPolyhedron& body) {
    std::vector<std::array<double, 3>> result;
    for (const Vec3& a : body.anchors) result.push_back({a.x(), a.y(), a.z()});
    std::sort(result.begin(), result.end());
    return result;
  };
  const ConvexPolyhedron plain = made(polyhedron_from_halfspaces(rows));
  const ConvexPolyhedron repeated = made(polyhedron_from_halfspaces(worse));
  EXPECT_EQ(positions(plain), positions(repeated));
  EXPECT_EQ(plain.facets.size(), repeated.facets.size());
  EXPECT_EQ(plain.edges.size(), repeated.edges.size());
  EXPECT_EQ(plain.position_error, repeated.position_error);
}

TEST(Shapes, ShortEdgesKeepAccurateDirections) {
  // Four planes almost through (1, 1, 1): the top edge is 2^-56 long, below the spacing of doubles
  // at its ends, and runs along x all the same.
  const std::vector<HalfSpace> rows = {
      {{0, 1, 1}, 2}, {{0, -1, 1}, 0}, {{1, 0, 1}, 2}, {{-1, 0, 1}, 0x1p-56}, {{0, 0, -1}, 1}};
  const ConvexPolyhedron body = made(polyhedron_from_halfspaces(rows));
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

TEST(Shapes, OneUnitInTheLastPlaceSeparatesAPlateFromNothing) {
  const double above = std::nextafter(1.0, 2.0);
  const double below = std::nextafter(1.0, 0.0);
  const ConvexPolyhedron plate =
      made(polyhedron_from_halfspaces(box_rows({-1, -1, 1.0}, {1, 1, above})));
  EXPECT_THAT(broken_invariants(plate), IsEmpty());
  EXPECT_EQ(plate.vertices.size(), 8U);
  EXPECT_EQ(plate.position_error, 0.0);
  EXPECT_EQ(
      refusal(polyhedron_from_halfspaces(box_rows({-1, -1, 1.0}, {1, 1, 1.0}))),
      "the half-spaces have no common interior: rows 3 and 6 leave only a flat piece between them");
  EXPECT_EQ(refusal(polyhedron_from_halfspaces(box_rows({-1, -1, 1.0}, {1, 1, below}))),
            "the half-spaces have no common point: rows 3 and 6 contradict each other");
}

TEST(Shapes, RowsNamedInARefusalAreAllNeeded) {
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

TEST(Shapes, PlanesAlmostParallelMayMeetFarAway) {
  const std::vector<HalfSpace> rows = {
      {{-0x1p-60, 1, 0}, 0}, {{0, -1, 0}, -1}, {{0, 0, 1}, 1}, {{0, 0, -1}, 1}};
  const ConvexPolyhedron body = made(polyhedron_from_halfspaces(rows));
  expect_as_enumerated(body, rows);
  ASSERT_EQ(body.vertices.size(), 2U);
  EXPECT_EQ(body.vertices[0].position.x(), 0x1p60);
  for (const Facet& facet : body.facets) {
    EXPECT_LE(facet.normal.dot(body.interior), facet.offset);
  }
}

TEST(Shapes, HalfSpaceHasOneBarePlane) {
  const ConvexPolyhedron body =
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

TEST(Shapes, SlabHasTwoBarePlanesAndTheirLines) {
  const std::vector<HalfSpace> rows = {{{1, 2, 2}, 9}, {{-2, -4, -4}, 9}, {{1, 2, 2}, 10}};
  const ConvexPolyhedron body = made(polyhedron_from_halfspaces(rows));
  EXPECT_THAT(broken_invariants(body), IsEmpty());
  ASSERT_EQ(body.facets.size(), 2U);
  EXPECT_EQ(body.facets[0].offset, 3.0);
  EXPECT_EQ(body.facets[1].offset, 1.5);
  EXPECT_EQ(body.rays.size(), 4U);
  EXPECT_TRUE(body.edges.empty());
  EXPECT_EQ(body.anchors[0], Vec3(1, 2, 2));
}

TEST(Shapes, WedgeHasOneFullLine) {
  const std::vector<HalfSpace> rows = {{{1, 1, 0}, 2}, {{-1, 1, 0}, 0}, {{0, 1, 0}, 7}};
  const ConvexPolyhedron body = made(polyhedron_from_halfspaces(rows));
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

TEST(Shapes, PrismWithoutEndsHasALineForEachSide) {
  for (const int sides : {3, 4, 9}) {
    std::vector<HalfSpace> rows;
    for (int i = 0; i < sides; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / sides;
      rows.push_back({{std::cos(angle), std::sin(angle), 0.25 * std::sin(angle)}, 1.0});
    }
    const ConvexPolyhedron body = made(polyhedron_from_halfspaces(rows));
    EXPECT_THAT(broken_invariants(body), IsEmpty());
    EXPECT_EQ(body.facets.size(), static_cast<std::size_t>(sides));
    EXPECT_EQ(body.edges.size(), static_cast<std::size_t>(sides));
    EXPECT_EQ(body.rays.size(), 2U);
  }
}

TEST(Shapes, OctantHasThreeRaysFromOneCorner) {
  const ConvexPolyhedron body = made(polyhedron_from_halfspaces(
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

TEST(Shapes, PrismTakesTheHullOfItsBase) {
  const std::vector<Eigen::Vector2d> base = {{0, 0}, {2, 0}, {1, 0}, {2, 2},
                                             {1, 1}, {0, 2}, {2, 0}};
  const ConvexPolyhedron body = made(prism(base, -0.5, 1.5));
  EXPECT_THAT(broken_invariants(body), IsEmpty());
  EXPECT_EQ(body.facets.size(), 6U);
  EXPECT_EQ(body.vertices.size(), 8U);
  EXPECT_EQ(body.position_error, 0.0);
  EXPECT_TRUE(body.interior.isApprox(Vec3(1, 1, 0.5)));
}

TEST(Shapes, PointAndSegmentHaveNoFacets) {
  const ConvexPolyhedron sphere = made(point({1, 2, 2}, 0.25));
  EXPECT_THAT(broken_invariants(sphere), IsEmpty());
  EXPECT_EQ(sphere.radius, 0.25);
  EXPECT_GE(sphere.bounding_radius, 3.0);
  const ConvexPolyhedron capsule = made(segment({1, 1, 1}, {1, 4, 5}, 0.5));
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
  EXPECT_THAT(rows_refused({{{1e-200, 0, 0}, 1e200}}), HasSubstr("1e100 m"));
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
  EXPECT_THAT(points_refused({{0, 0, 0}, {1e200, 0, 0}, {0, 1, 0}, {1, 1, 1}}),
              HasSubstr("1e100 m"));
  EXPECT_THAT(refusal(box({1, 0, 1})), HasSubstr("half extent y"));
  EXPECT_THAT(refusal(box({1, 1, -1})), HasSubstr("half extent z"));
  EXPECT_THAT(refusal(segment({1, 2, 3}, {1, 2, 3}, 0.1)), HasSubstr("the same point"));
  EXPECT_THAT(refusal(point({1, 2, kNan}, 0.1)), HasSubstr("not finite"));
  EXPECT_THAT(refusal(point({1, 2, 3}, -0.1)), HasSubstr("radius"));
  const std::vector<Eigen::Vector2d> line = {{0, 0}, {1, 1}, {2, 2}};
  EXPECT_THAT(refusal(prism(line, 0, 1)), HasSubstr("no area"));
  const std::vector<Eigen::Vector2d> triangle = {{0, 0}, {1, 0}, {0, 1}};
  EXPECT_THAT(refusal(prism(triangle, 1, 1)), HasSubstr("low end"));
}

TEST(Shapes, TheSameInputGivesTheSameBits) {
  Random random(29);
  const std::vector<HalfSpace> rows = hard::random_polytope(random, 40).rows;
  const ConvexPolyhedron first = made(polyhedron_from_halfspaces(rows));
  const ConvexPolyhedron second = made(polyhedron_from_halfspaces(rows));
  EXPECT_EQ(first.anchors, second.anchors);
  ASSERT_EQ(first.edges.size(), second.edges.size());
  for (std::size_t e = 0; e < first.edges.size(); ++e) {
    EXPECT_EQ(first.edges[e].direction, second.edges[e].direction);
    EXPECT_EQ(first.edges[e].end, second.edges[e].end);
  }
}

TEST(PolyhedronInvariants, NoticeEveryKindOfDamage) {
  const ConvexPolyhedron whole = made(box({1, 2, 3}));
  ASSERT_THAT(broken_invariants(whole), IsEmpty());
  const auto damaged = [&whole](auto damage) {
    ConvexPolyhedron body = whole;
    damage(body);
    return broken_invariants(body);
  };
  EXPECT_THAT(damaged([](auto& b) { b.facets[2].offset += 1e-9; }), Not(IsEmpty()));
  EXPECT_THAT(damaged([](auto& b) { b.facets[2].normal *= 1.0 + 1e-9; }), Not(IsEmpty()));
  EXPECT_THAT(damaged([](auto& b) { b.edges[3].end += 1e-9; }), Not(IsEmpty()));
  EXPECT_THAT(damaged([](auto& b) { b.edges[3].inward[1] *= -1.0; }), Not(IsEmpty()));
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
