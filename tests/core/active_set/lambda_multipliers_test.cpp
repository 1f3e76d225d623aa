// The lambda step: the release that brings a body closer fastest, and the proof if no release does.
#include "core/active_set/lambda_multipliers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/model/support_function.hpp"
#include "core/numerics/error_constants.hpp"
#include "tests/core/active_set/cube_features.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {
namespace {

TEST(Lambda, ReleasesNothingWhereNoFacetIsActive) {
  const ConvexBody body = cube();
  const ActiveFeature side = active(body, nullptr, FeatureKind::kInside, kNone, Vec3::Zero());
  EXPECT_EQ(lambda(side, Vec3::UnitX()).derivative, -kInfinity);
}

// (3.4.23): the multiplier of one active facet.
TEST(Lambda, OfAFacetIsTheDerivativeAgainstItsNormal) {
  const ConvexBody body = cube();
  const ActiveFeature side =
      active(body, nullptr, FeatureKind::kFacet, facet_towards(body, Vec3::UnitX()), {0.5, 0, 0});
  const Lambda away = lambda(side, {-3.0, 1.0, 0.0}), ahead = lambda(side, {3.0, 1.0, 0.0});
  EXPECT_EQ(away.derivative, 3.0);
  EXPECT_EQ(away.to, FeatureKind::kInside);
  EXPECT_EQ(away.index, kNone);
  EXPECT_EQ(ahead.derivative, -3.0);
}

// (3.4.24): of the two facets that meet in an edge, the step keeps the one along which the body
// comes closer.
TEST(Lambda, OfAnEdgeKeepsTheFacetAlongWhichTheBodyComesCloser) {
  const ConvexBody body = cube();
  // The edge between the facets towards +x and +y.
  const ActiveFeature side = active(body, nullptr, FeatureKind::kEdge,
                                    edge_around(body, {0.5, 0.5, 0.0}), {0.5, 0.5, 0.0});
  const Lambda along_x = lambda(side, {1.0, -2.0, 5.0});
  EXPECT_EQ(along_x.derivative, 2.0);
  EXPECT_EQ(along_x.to, FeatureKind::kFacet);
  EXPECT_EQ(along_x.index, facet_towards(body, Vec3::UnitX()));
  const Lambda along_y = lambda(side, {-2.0, 1.0, 5.0});
  EXPECT_EQ(along_y.derivative, 2.0);
  EXPECT_EQ(along_y.index, facet_towards(body, Vec3::UnitY()));
  EXPECT_EQ(lambda(side, {1.0, 2.0, 0.0}).derivative, -1.0);
}

// (3.4.25), evaluated over all edges of the vertex.
TEST(Lambda, OfAVertexKeepsTheSteepestEdge) {
  const ConvexBody body = cube();
  const Vec3 corner(0.5, 0.5, 0.5);
  const ActiveFeature side =
      active(body, nullptr, FeatureKind::kVertex, vertex_at(body, corner), corner);
  const Lambda release = lambda(side, {-1.0, -3.0, 2.0});
  EXPECT_EQ(release.derivative, 3.0);
  EXPECT_EQ(release.to, FeatureKind::kEdge);
  EXPECT_EQ(release.index, edge_around(body, {0.5, 0.0, 0.5}));
  EXPECT_EQ(lambda(side, {1.0, 3.0, 2.0}).derivative, -1.0);
}

TEST(Lambda, TakesTheDirectionInFrameA) {
  const ConvexBody body = cube();
  const RelativePose quarter =
      relative_pose(Pose{}, {{5, 6, 7}, turned(Vec3::UnitZ(), 0.5 * std::numbers::pi)});
  const ActiveFeature side =
      active(body, &quarter, FeatureKind::kFacet, facet_towards(body, Vec3::UnitX()), {0.5, 0, 0});
  EXPECT_NEAR(lambda(side, {0.0, -2.0, 0.0}).derivative, 2.0, 1e-15);
}

TEST(Lambda, OfBodiesWithoutFacetsReleasesNothingAtTheirLastFeature) {
  const ConvexBody dot = made(point({1, 2, 3}, 0.5)), line = made(segment({0, 0, 0}, {1, 0, 0}, 0));
  const ActiveFeature at_point = active(dot, nullptr, FeatureKind::kVertex, 0, {1, 2, 3});
  const ActiveFeature on_line = active(line, nullptr, FeatureKind::kEdge, 0, {0.5, 0, 0});
  for (const Vec3& direction : {Vec3(Vec3::UnitX()), Vec3(-Vec3::UnitX()), Vec3(Vec3::UnitY())}) {
    EXPECT_EQ(lambda(at_point, direction).derivative, -kInfinity);
    EXPECT_EQ(lambda(on_line, direction).derivative, -kInfinity);
  }
}

// A small step along the remaining feature gains what the derivative predicts. This is the
// definition of a directional derivative, with the other point far away.
TEST(Lambda, IsTheGainPerMetreOfTheReleaseThatItNames) {
  Random random(32);
  for (int k = 0; k < 500; ++k) {
    const ConvexBody body = made(hard::random_polytope(random, random.integer(6, 30)));
    const Vec3 direction = random.direction();
    const ActiveFeature vertex = active(body, nullptr, FeatureKind::kVertex, random.integer(0, 99));
    const Lambda from_vertex = lambda(vertex, direction);
    double best = -kInfinity;
    for (const Edge& edge : body.edges) {
      for (int end = 0; end < 2; ++end) {
        if (edge.vertex[end] != vertex.index()) continue;
        const Vec3 far = body.vertices[edge.vertex[1 - end]].position;
        best = std::max(best, (far - vertex.point_L()).normalized().dot(direction));
      }
    }
    EXPECT_NEAR(from_vertex.derivative, best, 1e-9) << k;

    const ActiveFeature on_edge = active(body, nullptr, FeatureKind::kEdge, random.integer(0, 99));
    const Lambda from_edge = lambda(on_edge, direction);
    const Facet& kept = body.facets[from_edge.index];
    const Vec3 into = kept.normal.cross(on_edge.edge().direction);
    EXPECT_NEAR(std::abs(from_edge.derivative), std::abs(into.dot(direction)), 1e-9) << k;
  }
}

// A negative derivative ends the iteration, because no point of the body lies farther along the
// direction than the feature.
TEST(Lambda, ThatIsNegativeProvesTheFeatureToBeTheSupportAlongTheDirection) {
  Random random(33);
  int proved = 0;
  for (int k = 0; k < 3000; ++k) {
    const ConvexBody body = made(hard::random_polytope(random, random.integer(4, 12)));
    const ActiveFeature vertex = active(body, nullptr, FeatureKind::kVertex, random.integer(0, 99));
    const Vec3 direction = random.direction();
    const bool is_support = support_by_scan(body, direction).anchor == vertex.index();
    const double derivative = lambda(vertex, direction).derivative;
    if (std::abs(derivative) < 1e-9) continue;
    EXPECT_EQ(derivative < 0.0, is_support) << k;
    proved += is_support;
  }
  EXPECT_GT(proved, 200);
}

}  // namespace
}  // namespace clearance::test
