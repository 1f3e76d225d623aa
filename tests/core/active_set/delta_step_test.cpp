// The ten cases of Table 3.1 on unit cubes, whose features have simple coordinates. Further tests
// check laws of all cases on random polytopes.
//
// A is test::cube() at the origin. B is another such cube, whose pose moves every feature.
#include "core/active_set/delta_step.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/active_set/cube_features.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using test::active;
using test::at;
using test::cube;
using test::edge_around;
using test::facet_towards;
using test::made;
using test::turned;
using test::vertex_at;

constexpr FeatureKind kKinds[] = {FeatureKind::kVertex, FeatureKind::kEdge, FeatureKind::kFacet,
                                  FeatureKind::kInside};

void expect_near(const Vec3& found, const Vec3& wanted) {
  EXPECT_LE((found - wanted).norm(), 1e-15 * (1.0 + wanted.norm()))
      << found.transpose() << " instead of " << wanted.transpose();
}

class DeltaStep : public testing::Test {
 protected:
  // Sets frame A from frame B.
  void place(const Pose& pose_of_b) { pose_ = relative_pose(Pose{}, pose_of_b); }

  [[nodiscard]] ActiveFeature vertex_of_a(const Vec3& position) const {
    return active(cube_, nullptr, FeatureKind::kVertex, vertex_at(cube_, position), position);
  }
  [[nodiscard]] ActiveFeature edge_of_a(const Vec3& middle, const Vec3& own) const {
    return active(cube_, nullptr, FeatureKind::kEdge, edge_around(cube_, middle), own);
  }
  [[nodiscard]] ActiveFeature facet_of_a(const Vec3& normal, const Vec3& own) const {
    return active(cube_, nullptr, FeatureKind::kFacet, facet_towards(cube_, normal), own);
  }
  [[nodiscard]] ActiveFeature inside_a(const Vec3& own) const {
    return active(cube_, nullptr, FeatureKind::kInside, kNone, own);
  }
  [[nodiscard]] ActiveFeature vertex_of_b(const Vec3& position) const {
    return active(cube_, &pose_, FeatureKind::kVertex, vertex_at(cube_, position), position);
  }
  [[nodiscard]] ActiveFeature edge_of_b(const Vec3& middle, const Vec3& own) const {
    return active(cube_, &pose_, FeatureKind::kEdge, edge_around(cube_, middle), own);
  }
  [[nodiscard]] ActiveFeature facet_of_b(const Vec3& normal, const Vec3& own) const {
    return active(cube_, &pose_, FeatureKind::kFacet, facet_towards(cube_, normal), own);
  }
  [[nodiscard]] ActiveFeature inside_b(const Vec3& own) const {
    return active(cube_, &pose_, FeatureKind::kInside, kNone, own);
  }

  const ConvexBody cube_ = cube();
  RelativePose pose_;
};

TEST_F(DeltaStep, LeavesTwoVerticesWhereTheyAre) {
  place(at(3, 1, 0));
  const Delta d = delta(vertex_of_a({0.5, 0.5, 0.5}), vertex_of_b({-0.5, -0.5, -0.5}));
  expect_near(d.a, {0.5, 0.5, 0.5});
  expect_near(d.b, {2.5, 0.5, -0.5});
}

TEST_F(DeltaStep, GoesFromAVertexToTheFootOnTheLineOfAnEdge) {
  place(at(3, 0.25, 0));
  // B's edge lies along y at x = 2.5, z = -0.5, and ends before the foot at y = 0.5 + 0.
  const Delta d =
      delta(vertex_of_a({0.5, 0.5, -0.5}), edge_of_b({-0.5, 0, -0.5}, {-0.5, 0.1, -0.5}));
  expect_near(d.a, {0.5, 0.5, -0.5});
  expect_near(d.b, {2.5, 0.5, -0.5});
}

TEST_F(DeltaStep, GoesFromAVertexToTheFootOnTheFootOfAFacetsPlane) {
  place(at(3, 0.25, 0));
  const Delta d = delta(vertex_of_a({0.5, 0.5, -0.5}), facet_of_b({-1, 0, 0}, {-0.5, 0, 0.1}));
  expect_near(d.a, {0.5, 0.5, -0.5});
  expect_near(d.b, {2.5, 0.5, -0.5});
}

TEST_F(DeltaStep, MeetsAtTheVertexWhereTheOtherBodyHasNoActiveFacet) {
  place(at(3, 0.25, 0));
  const Delta d = delta(vertex_of_a({0.5, 0.5, -0.5}), inside_b({0.1, 0.2, 0.3}));
  expect_near(d.a, {0.5, 0.5, -0.5});
  expect_near(d.b, {0.5, 0.5, -0.5});
}

TEST_F(DeltaStep, GoesToTheCommonPerpendicularOfTwoCrossingEdges) {
  place(at(3, 0, 0));
  // A's edge lies along z at (0.5, 0.5), B's along y at x = 2.5, z = 0.5.
  const Delta d = delta(edge_of_a({0.5, 0.5, 0}, {0.5, 0.5, -0.2}),
                        edge_of_b({-0.5, 0, 0.5}, {-0.5, 0.1, 0.5}));
  expect_near(d.a, {0.5, 0.5, 0.5});
  expect_near(d.b, {2.5, 0.5, 0.5});
}

// §3.4.2.1: many pairs are closest, and the step chooses the one with the smallest move.
TEST_F(DeltaStep, MovesTheTwoPointsHalfwayEachAlongParallelEdges) {
  place(at(3, 0, 0));
  const Delta d = delta(edge_of_a({0.5, 0.5, 0}, {0.5, 0.5, -0.25}),
                        edge_of_b({-0.5, -0.5, 0}, {-0.5, -0.5, 0.5}));
  expect_near(d.a, {0.5, 0.5, 0.125});
  expect_near(d.b, {2.5, -0.5, 0.125});
}

TEST_F(DeltaStep, GoesToWhereTheLineOfAnEdgeMeetsThePlaneOfAFacet) {
  place({{3, 0, 0}, turned(Vec3::UnitZ(), std::atan2(3.0, 4.0))});
  // A's edge lies along x. B's facet has the normal (-0.8, -0.6, 0) and contains (2.6, -0.3, 0).
  const Delta d =
      delta(edge_of_a({0, 0.5, 0.5}, {0.1, 0.5, 0.5}), facet_of_b({-1, 0, 0}, {-0.5, 0.2, 0.3}));
  expect_near(d.a, {2.0, 0.5, 0.5});
  expect_near(d.b, {2.0, 0.5, 0.5});
}

TEST_F(DeltaStep, MovesTheTwoPointsHalfwayEachWhereAnEdgeIsParallelToAFacet) {
  place(at(3, 0, 0));
  const Delta d = delta(edge_of_a({0.5, 0.5, 0}, {0.5, 0.5, -0.25}),
                        facet_of_b({-1, 0, 0}, {-0.5, -0.25, 0.5}));
  expect_near(d.a, {0.5, 0.5, 0.125});
  expect_near(d.b, {2.5, 0.5, 0.125});
}

TEST_F(DeltaStep, MeetsAtTheFootOnTheLineOfAnEdgeWhereTheOtherBodyHasNoActiveFacet) {
  place(at(3, 0, 0));
  const Delta d = delta(edge_of_a({0.5, 0.5, 0}, {0.5, 0.5, -0.25}), inside_b({0.1, 0.2, 0.3}));
  expect_near(d.a, {0.5, 0.5, 0.3});
  expect_near(d.b, {0.5, 0.5, 0.3});
}

// Both points move to the intersection line of the planes, halfway between their feet.
TEST_F(DeltaStep, GoesToTheLineInWhichTwoPlanesMeet) {
  place(at(3, 0, 2));
  // A's plane is z = 0.5, B's is x = 2.5.
  const Delta d =
      delta(facet_of_a({0, 0, 1}, {0.25, 0.25, 0.5}), facet_of_b({-1, 0, 0}, {-0.5, -0.25, 0.1}));
  expect_near(d.a, {2.5, 0.0, 0.5});
  expect_near(d.b, {2.5, 0.0, 0.5});
}

TEST_F(DeltaStep, MovesTheTwoPointsHalfwayEachBetweenParallelPlanes) {
  place(at(3, 0, 0));
  const Delta d =
      delta(facet_of_a({1, 0, 0}, {0.5, 0.25, 0.0}), facet_of_b({-1, 0, 0}, {-0.5, -0.25, 0.5}));
  expect_near(d.a, {0.5, 0.0, 0.25});
  expect_near(d.b, {2.5, 0.0, 0.25});
}

TEST_F(DeltaStep, MeetsAtTheFootOnThePlaneOfAFacetWhereTheOtherBodyHasNoActiveFacet) {
  place(at(3, 0, 0));
  const Delta d = delta(facet_of_a({1, 0, 0}, {0.5, 0.25, 0.0}), inside_b({0.1, 0.2, 0.3}));
  expect_near(d.a, {0.5, 0.2, 0.3});
  expect_near(d.b, {0.5, 0.2, 0.3});
}

TEST_F(DeltaStep, MeetsHalfwayWhereNeitherBodyHasAnActiveFacet) {
  place(at(3, 0, 0));
  const Delta d = delta(inside_a({0.1, 0.2, 0.3}), inside_b({0.1, -0.2, 0.1}));
  expect_near(d.a, {1.6, 0.0, 0.2});
  expect_near(d.b, {1.6, 0.0, 0.2});
}

// Directions in frame A that span the affine hull of a feature.
std::vector<Vec3> directions_within(const ActiveFeature& s) {
  switch (s.feature()) {
    case FeatureKind::kVertex:
      return {};
    case FeatureKind::kEdge:
      return {s.direction_to_a(s.edge().direction)};
    case FeatureKind::kFacet: {
      const Vec3 n = s.facet().normal, e = n.unitOrthogonal();
      return {s.direction_to_a(e), s.direction_to_a(n.cross(e))};
    }
    default:
      return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  }
}

// The length of a move's component normal to the affine hull.
double off_the_hull(const ActiveFeature& s, Vec3 move) {
  for (const Vec3& direction : directions_within(s)) move -= move.dot(direction) * direction;
  return move.norm();
}

// The KKT conditions of two affine hulls: the points lie on them, and the vector between the points
// is normal to both. For the angles of these pairs, rounding accounts for up to 1e-8 m.
TEST_F(DeltaStep, EndsOnBothHullsAtRightAnglesToThem) {
  Random random(29);
  for (int k = 0; k < 400; ++k) {
    const ConvexBody a = made(hard::random_polytope(random, 8)),
                     b = made(hard::random_polytope(random, 12));
    const RelativePose pose = relative_pose(Pose{}, random.pose(3.0));
    for (const FeatureKind kind_a : kKinds) {
      for (const FeatureKind kind_b : kKinds) {
        const ActiveFeature p = active(a, nullptr, kind_a, random.integer(0, 99));
        const ActiveFeature q = active(b, &pose, kind_b, random.integer(0, 99));
        const Delta d = delta(p, q);
        const double size = 1.0 + d.a.norm() + d.b.norm();
        EXPECT_LE(off_the_hull(p, d.a - p.point_A()), 1e-11 * size) << k;
        EXPECT_LE(off_the_hull(q, d.b - q.point_A()), 1e-11 * size) << k;
        for (const ActiveFeature* s : {&p, &q}) {
          for (const Vec3& direction : directions_within(*s)) {
            EXPECT_LE(std::abs((d.b - d.a).dot(direction)), 1e-11 * size) << k;
          }
        }
      }
    }
  }
}

TEST_F(DeltaStep, IsItsOwnMirrorImageWhereTheBodiesChangePlaces) {
  Random random(30);
  for (int k = 0; k < 100; ++k) {
    const ConvexBody body = made(hard::random_polytope(random, 10));
    const RelativePose pose = relative_pose(Pose{}, random.pose(3.0));
    for (const FeatureKind first : kKinds) {
      for (const FeatureKind second : kKinds) {
        if (first == second) continue;  // the roundings then depend on the order
        const ActiveFeature p = active(body, nullptr, first, random.integer(0, 99));
        const ActiveFeature q = active(body, &pose, second, random.integer(0, 99));
        const Delta d = delta(p, q), mirrored = delta(q, p);
        EXPECT_EQ(d.a, mirrored.b);
        EXPECT_EQ(d.b, mirrored.a);
      }
    }
  }
}

}  // namespace
}  // namespace clearance
