// The alpha step: how far a point may move before a facet blocks it.
//
// Oracle: the ratio test over all half-spaces of the body (§3.3.1.3). The code examines only the
// boundary of the current feature, which must give the same result.
#include "core/active_set/alpha_step_length.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/active_set/cube_features.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {
namespace {

TEST(AlphaStep, FromTheInsideStopsAtTheFirstFacet) {
  const ConvexBody body = cube();
  const ActiveFeature side = active(body, nullptr, FeatureKind::kInside, kNone, Vec3::Zero());
  const Alpha step = alpha(side, {2.0, 1.0, -0.5});
  EXPECT_EQ(step.fraction, 0.25);
  EXPECT_EQ(step.blocking, facet_towards(body, Vec3::UnitX()));
}

TEST(AlphaStep, IsWholeWhereNothingBlocks) {
  const ConvexBody body = cube();
  const Vec3 inward(-0.5, 0.25, 0.0);
  for (const ActiveFeature& side :
       {active(body, nullptr, FeatureKind::kInside, kNone, {0.25, 0, 0}),
        active(body, nullptr, FeatureKind::kFacet, facet_towards(body, Vec3::UnitZ()),
               {0.25, 0.0, 0.5}),
        active(body, nullptr, FeatureKind::kEdge, edge_around(body, {0.0, 0.5, 0.5}),
               {0.25, 0.5, 0.5}),
        active(body, nullptr, FeatureKind::kVertex, vertex_at(body, {0.5, 0.5, 0.5}),
               {0.5, 0.5, 0.5})}) {
    const Alpha step = alpha(side, inward);
    EXPECT_EQ(step.fraction, 1.0);
    EXPECT_EQ(step.blocking, kNone);
  }
}

TEST(AlphaStep, OnAFacetStopsAtTheEdgeThatItCrosses) {
  const ConvexBody body = cube();
  const ActiveFeature side = active(body, nullptr, FeatureKind::kFacet,
                                    facet_towards(body, Vec3::UnitZ()), {0.0, 0.25, 0.5});
  const Alpha step = alpha(side, {0.25, 1.0, 0.0});
  EXPECT_EQ(step.fraction, 0.25);
  EXPECT_EQ(step.blocking, edge_around(body, {0.0, 0.5, 0.5}));
}

TEST(AlphaStep, OnAnEdgeStopsAtTheVertexThatItPasses) {
  const ConvexBody body = cube();
  const ActiveFeature side = active(body, nullptr, FeatureKind::kEdge,
                                    edge_around(body, {0.0, 0.5, 0.5}), {0.25, 0.5, 0.5});
  for (const double sign : {1.0, -1.0}) {
    const Alpha step = alpha(side, {3.0 * sign, 0.0, 0.0});
    EXPECT_EQ(step.fraction, (sign > 0.0 ? 0.25 : 0.75) / 3.0);
    EXPECT_EQ(step.blocking, vertex_at(body, {0.5 * sign, 0.5, 0.5}));
  }
}

TEST(AlphaStep, IsOfNoLengthWhereRoundingHasLetThePointPassTheBoundary) {
  const ConvexBody body = cube();
  const double past = std::nextafter(0.5, 1.0);
  const ActiveFeature inside = active(body, nullptr, FeatureKind::kInside, kNone, {past, 0, 0});
  EXPECT_EQ(alpha(inside, {1.0, 0.0, 0.0}).fraction, 0.0);
  EXPECT_EQ(alpha(inside, {-1.0, 0.0, 0.0}).fraction, 1.0);
  const ActiveFeature facet = active(body, nullptr, FeatureKind::kFacet,
                                     facet_towards(body, Vec3::UnitZ()), {past, 0.0, 0.5});
  EXPECT_EQ(alpha(facet, {1.0, 0.0, 0.0}).fraction, 0.0);
  const ActiveFeature edge = active(body, nullptr, FeatureKind::kEdge,
                                    edge_around(body, {0.0, 0.5, 0.5}), {past, 0.5, 0.5});
  EXPECT_EQ(alpha(edge, {1.0, 0.0, 0.0}).fraction, 0.0);
}

// A point past an end goes back along its edge.
TEST(AlphaStep, IsWholeTowardsTheEdgeFromPastItsEnd) {
  const ConvexBody body = cube();
  for (const double sign : {1.0, -1.0}) {
    const ActiveFeature edge =
        active(body, nullptr, FeatureKind::kEdge, edge_around(body, {0.0, 0.5, 0.5}),
               {sign * (0.5 + 0x1p-40), 0.5, 0.5});
    for (const double back : {0.0, 0x1p-45, 0.25}) {
      const Alpha step = alpha(edge, {-sign * back, 0.0, 0.0});
      EXPECT_EQ(step.fraction, 1.0) << sign << ' ' << back;
      EXPECT_EQ(step.blocking, kNone);
    }
  }
}

TEST(AlphaStep, TakesTheMoveInFrameAAndTheBoundaryInTheBodysOwn) {
  const ConvexBody body = cube();
  const RelativePose quarter =
      relative_pose(Pose{}, {{5, 6, 7}, turned(Vec3::UnitZ(), 0.5 * std::numbers::pi)});
  const ActiveFeature side = active(body, &quarter, FeatureKind::kInside, kNone, Vec3::Zero());
  const Alpha step = alpha(side, {0.0, 2.0, 0.0});  // along B's x-axis
  EXPECT_NEAR(step.fraction, 0.25, 1e-15);
  EXPECT_EQ(step.blocking, facet_towards(body, Vec3::UnitX()));
}

// The component of a move within the affine hull of the feature.
Vec3 within_hull(const ActiveFeature& s, const Vec3& move) {
  if (s.feature() == FeatureKind::kInside) return move;
  if (s.feature() == FeatureKind::kFacet) {
    return move - move.dot(s.facet().normal) * s.facet().normal;
  }
  return move.dot(s.edge().direction) * s.edge().direction;
}

// The largest fraction of the move, at most one, that stays within all half-spaces. Half-spaces
// whose plane contains the feature are left out: they do not block, and rounding hides them.
double largest_part(const ActiveFeature& s, const Vec3& move) {
  double part = 1.0;
  for (const Facet& facet : s.body().facets) {
    const double gap = facet.offset - facet.normal.dot(s.point_L()), speed = facet.normal.dot(move);
    if (gap < 1e-9 || !(speed > 0.0)) continue;
    part = std::min(part, gap / speed);
  }
  return part;
}

TEST(AlphaStep, IsThatOfTheRatioTestOverAllHalfSpaces) {
  Random random(31);
  for (int k = 0; k < 500; ++k) {
    const ConvexBody body = made(hard::random_polytope(random, random.integer(6, 30)));
    for (const FeatureKind kind : {FeatureKind::kEdge, FeatureKind::kFacet, FeatureKind::kInside}) {
      const ActiveFeature side = active(body, nullptr, kind, random.integer(0, 99));
      const Vec3 move = within_hull(
          side, random.log_uniform(1e-2, 1e2) * body.bounding_radius * random.direction());
      EXPECT_NEAR(alpha(side, move).fraction, largest_part(side, move), 1e-6) << k;
    }
  }
}

TEST(AlphaStep, LeavesThePointOnTheFeatureThatBlocked) {
  const ConvexBody body = cube();
  ActiveFeature side = active(body, nullptr, FeatureKind::kInside, kNone, Vec3::Zero());
  const Vec3 move(2.0, 1.5, 1.25);
  const FeatureKind kinds[] = {FeatureKind::kFacet, FeatureKind::kEdge, FeatureKind::kVertex};
  const Vec3 points[] = {
      {0.5, 0.375, 0.3125}, {0.5, 0.5, 0.3125 + 0.125 / 1.5 * 1.25}, {0.5, 0.5, 0.5}};
  for (int k = 0; k < 3; ++k) {
    advance(side, move, alpha(side, move));
    EXPECT_EQ(side.feature(), kinds[k]);
    EXPECT_LE((side.point_L() - points[k]).norm(), 1e-15) << k;
  }
}

}  // namespace
}  // namespace clearance::test
