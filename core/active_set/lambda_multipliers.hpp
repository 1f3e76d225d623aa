// The 'lambda' step: does the release of an active facet bring the bodies closer? (§3.4.3)
#pragma once

#include "core/active_set/active_feature.hpp"
#include "core/model/edge_scan.hpp"

namespace clearance {

struct Lambda {
  // The best directional derivative of the approach to the other point: > 0 means release. If it is
  // negative by more than rounding, the feature is the support set of its body along `direction`.
  double derivative = -kInfinity;
  FeatureKind to = FeatureKind::kInside;  // the feature that remains
  std::int32_t index = kNone;
};

namespace lambda_case {

inline Lambda of_facet(const ActiveFeature& side, const Vec3& direction) noexcept {
  return {-side.facet().normal.dot(direction), FeatureKind::kInside, kNone};
}

inline Lambda of_edge(const ActiveFeature& side, const Vec3& direction) noexcept {
  const Edge& edge = side.edge();
  if (edge.facet[0] == kNone) return {};
  const double left = edge.inward.row(0).dot(direction), right = edge.inward.row(1).dot(direction);
  return left >= right ? Lambda{left, FeatureKind::kFacet, edge.facet[0]}
                       : Lambda{right, FeatureKind::kFacet, edge.facet[1]};
}

inline Lambda of_vertex(const ActiveFeature& side, const Vec3& direction) noexcept {
  const SteepestEdge steepest = steepest_edge(side.body(), side.vertex(), direction);
  if (steepest.at == kNone) return {};
  return {steepest.derivative, FeatureKind::kEdge, side.body().vertex_edges[steepest.at].edge};
}

}  // namespace lambda_case

// The release that gains most. `direction` points from this body's x to the other's, in frame A.
// The derivative is minus the multiplier of the thesis, equations (3.4.23) to (3.4.25). The last of
// these considers three edges of one choice of facets; this function considers all edges that leave
// the vertex. All derivatives are in the unit of `direction`, so that those of the two bodies can
// be compared. The scaling of (3.4.25) serves the same end.
[[nodiscard]] inline Lambda lambda(const ActiveFeature& side, const Vec3& direction_in_a) noexcept {
  if (side.feature() == FeatureKind::kInside) return {};
  const Vec3 direction = side.direction_A_to_L(direction_in_a);
  if (side.feature() == FeatureKind::kFacet) return lambda_case::of_facet(side, direction);
  return side.feature() == FeatureKind::kEdge ? lambda_case::of_edge(side, direction)
                                              : lambda_case::of_vertex(side, direction);
}

}  // namespace clearance
