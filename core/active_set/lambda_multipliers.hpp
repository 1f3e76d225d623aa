// The 'lambda' step: does letting go of an active facet bring the bodies closer? (§3.4.3)
#pragma once

#include <algorithm>

#include "core/active_set/active_feature.hpp"
#include "core/model/edge_scan.hpp"

namespace clearance {

struct Lambda {
  // How fast the point may approach the other, per unit of path, at best: > 0 asks for release.
  // Negative beyond rounding, it proves that the feature is the farthest of its body along
  // `towards`.
  double rate = -kInfinity;
  FeatureKind to = FeatureKind::kInside;  // the feature that remains
  std::int32_t index = kNone;
};

namespace lambda_case {

inline Lambda of_facet(const ActiveFeature& side, const Vec3& towards) noexcept {
  return {-side.facet().normal.dot(towards), FeatureKind::kInside, kNone};
}

inline Lambda of_edge(const ActiveFeature& side, const Vec3& towards) noexcept {
  const Edge& edge = side.edge();
  if (edge.facet[0] == kNone) return {};
  const double left = edge.inward.row(0).dot(towards), right = edge.inward.row(1).dot(towards);
  return left >= right ? Lambda{left, FeatureKind::kFacet, edge.facet[0]}
                       : Lambda{right, FeatureKind::kFacet, edge.facet[1]};
}

inline Lambda of_vertex(const ActiveFeature& side, const Vec3& towards) noexcept {
  const SteepestEdge steepest = steepest_edge(side.body(), side.vertex(), towards);
  if (steepest.at == kNone) return {};
  return {steepest.derivative, FeatureKind::kEdge, side.body().vertex_edges[steepest.at].edge};
}

// The facets between the vertex's edges, one by one: along what is across each of two neighbours.
inline Lambda of_facets_at_vertex(const ActiveFeature& side, const Vec3& towards) noexcept {
  const ConvexPolyhedron& body = side.body();
  const Vertex& vertex = side.vertex();
  const auto across = [&](const EdgeUse& use, int k) {
    return body.edges[use.edge].inward.row(k).dot(towards);
  };
  Lambda best;
  for (std::int32_t i = 0; i < vertex.edges; ++i) {
    const EdgeUse& right = body.vertex_edges[vertex.first_edge + i];
    const EdgeUse& left = body.vertex_edges[vertex.first_edge + (i + 1) % vertex.edges];
    const double rate = std::min(across(right, right.side), across(left, 1 - left.side));
    if (rate > best.rate) {
      best = {rate, FeatureKind::kFacet, body.edges[right.edge].facet[right.side]};
    }
  }
  return best;
}

}  // namespace lambda_case

// The release that gains most. `towards` points from this body's x to the other's, common frame.
// The rate is minus the multiplier of the thesis: its three cases (3.4.23) to (3.4.25), the last
// one over all edges that leave the vertex rather than the three of one choice of facets. All rates
// are in the unit of `towards`, so that they can be compared between the bodies, as the scaling of
// (3.4.25) is there for.
[[nodiscard]] inline Lambda lambda(const ActiveFeature& side,
                                   const Vec3& towards_in_common) noexcept {
  if (side.feature() == FeatureKind::kInside) return {};
  const Vec3 towards = side.direction_to_own(towards_in_common);
  if (side.feature() == FeatureKind::kFacet) return lambda_case::of_facet(side, towards);
  return side.feature() == FeatureKind::kEdge ? lambda_case::of_edge(side, towards)
                                              : lambda_case::of_vertex(side, towards);
}

}  // namespace clearance
