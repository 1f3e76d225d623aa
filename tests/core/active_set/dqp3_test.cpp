// The active-set iteration from features that no query has chosen. Oracles: closed forms.
#include "core/active_set/dqp3.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/shapes.hpp"
#include "tests/core/active_set/cube_features.hpp"
#include "tests/shared/made.hpp"

namespace clearance::test {
namespace {

// A cube with edges of 2 m whose lower face is folded along the y-axis by one ulp.
ConvexBody folded_below() {
  const double fold = std::nextafter(-1.0, -2.0);
  return made(polyhedron_from_vertices(std::vector<Vec3>{{-1, -1, 1},
                                                         {1, -1, 1},
                                                         {-1, 1, 1},
                                                         {1, 1, 1},
                                                         {-1, -1, -1},
                                                         {1, -1, -1},
                                                         {-1, 1, -1},
                                                         {1, 1, -1},
                                                         {0, -1, fold},
                                                         {0, 1, fold}}));
}

// No facet beside the fold approaches the point above the body by more than rounding, and yet the
// closest point is on the opposite side.
TEST(Dqp3, LeavesAnEdgeOfLevelFacetsOnTheFarSideThroughTheInside) {
  const ConvexBody body = folded_below(), tip = made(point({0.0, 0.5, 5.0}, 0.0));
  const RelativePose here = relative_pose(Pose{}, Pose{});
  std::int32_t fold = kNone;
  for (std::size_t i = 0; i < body.edges.size(); ++i) {
    const Edge& edge = body.edges[i];
    if ((edge.point + 0.5 * edge.end * edge.direction).head<2>().isZero(0.0) &&
        edge.point.z() < 0.0) {
      fold = static_cast<std::int32_t>(i);
    }
  }
  ASSERT_NE(fold, kNone);
  for (const bool folded_is_a : {true, false}) {
    ActiveFeature edge(body, folded_is_a ? nullptr : &here);
    edge.place_on_edge(fold, Vec3::Zero());
    ActiveFeature vertex(tip, folded_is_a ? &here : nullptr);
    vertex.place_at_vertex(0);
    const Dqp3Outcome outcome = folded_is_a ? dqp3(edge, vertex, 1e-15) : dqp3(vertex, edge, 1e-15);
    EXPECT_EQ(outcome.end, Dqp3End::kCertified);
    EXPECT_EQ(edge.point_A(), Vec3(0.0, 0.5, 1.0));
    ASSERT_EQ(edge.feature(), FeatureKind::kFacet);
    EXPECT_EQ(edge.facet().normal, Vec3::UnitZ());
  }
}

}  // namespace
}  // namespace clearance::test
