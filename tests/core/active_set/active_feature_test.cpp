// Corrects a body's point where rounding, or the state of another pair, would move it out of the
// body.
#include "core/active_set/active_feature.hpp"

#include <gtest/gtest.h>

#include "core/active_set/alpha_step_length.hpp"
#include "tests/core/active_set/cube_features.hpp"
#include "tests/shared/made.hpp"

namespace clearance {
namespace {

using test::cube;
using test::facet_towards;
using test::half_space;

TEST(ActiveFeature, GoesToTheFacetUnderTheEndOfAMoveThroughTheInside) {
  const ConvexBody body = cube();
  ActiveFeature side(body, nullptr);
  side.place_inside(Vec3::Zero());
  // The point lies on the plane of the facet that is said to block, one metre beside the facet.
  advance(side, Vec3(0.5, 1.5, 0.0), {1.0, facet_towards(body, Vec3::UnitX())});
  ASSERT_EQ(side.feature(), FeatureKind::kFacet);
  EXPECT_EQ(side.facet().normal, Vec3::UnitY());
  EXPECT_EQ(side.point_L(), Vec3(0.5, 0.5, 0.0));
}

TEST(ActiveFeature, OfAnUnboundedBodyStartsNoFartherOutThanAnyClosestPoint) {
  const ConvexBody floor = half_space(Vec3::UnitZ(), 0.0), box = cube();
  const ActiveFeature other(box, nullptr);
  const TrackingState::Side near{FeatureKind::kFacet, false, 0, {1.0, 2.0, 0.0}},
      far{FeatureKind::kFacet, false, 0, {1e17, 2.0, 0.0}};
  ActiveFeature side(floor, nullptr);
  side.place_near(near, other, 2.0);
  EXPECT_EQ(side.point_L(), near.point);
  side.place_near(far, other, 2.0);
  EXPECT_LT(side.point_L().norm(), 10.0);
}

}  // namespace
}  // namespace clearance
