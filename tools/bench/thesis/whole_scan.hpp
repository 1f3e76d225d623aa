// Alpha as it is without adjacency: over every facet that is not active (3.3.11), (3.3.12).
#pragma once

#include "core/active_set/alpha_step_length.hpp"

namespace clearance::bench {

// The edge of `facet` across which `other` lies; kNone if they do not meet in one.
[[nodiscard]] inline std::int32_t edge_between(const ConvexBody& body, const Facet& facet,
                                               std::int32_t other) {
  for (std::int32_t i = facet.first_side; i < facet.first_side + facet.sides; ++i) {
    const EdgeUse& use = body.facet_edges[i];
    if (body.edges[use.edge].facet[1 - use.side] == other) return use.edge;
  }
  return kNone;
}

// The same result as alpha(), found by scanning all facets.
[[nodiscard]] inline Alpha alpha_over_all(const ActiveFeature& side, const Vec3& move_in_a) {
  if (side.feature() == FeatureKind::kVertex || side.feature() == FeatureKind::kInside) {
    return alpha(side, move_in_a);
  }
  const ConvexBody& body = side.body();
  const Vec3 move = side.direction_A_to_L(move_in_a);
  const bool on_edge = side.feature() == FeatureKind::kEdge;
  const std::int32_t active[2] = {on_edge ? side.edge().facet[0] : side.index(),
                                  on_edge ? side.edge().facet[1] : kNone};
  // A vertex where many facets meet lets x pass along their common edge only up to rounding.
  constexpr double kAlong = 1e-14;
  const double least = kAlong * move.norm();
  Alpha best;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(body.facets.size()); ++i) {
    if (i == active[0] || i == active[1]) continue;
    const Facet& facet = body.facets[i];
    const double speed = facet.normal.dot(move);
    if (!(speed > least)) continue;
    const double gap = facet.offset - facet.normal.dot(side.point_L());
    if (gap < best.fraction * speed) best = {alpha_case::fraction(gap, speed), i};
  }
  if (best.blocking == kNone) return best;
  if (on_edge) {
    best.blocking = side.edge().vertex[side.edge().direction.dot(move) > 0.0 ? 1 : 0];
    return best;
  }
  // More than three facets may meet. Then the facet that was hit first may touch this one in a
  // vertex only, and the facet's own boundary decides.
  best.blocking = edge_between(body, side.facet(), best.blocking);
  return best.blocking == kNone ? alpha(side, move_in_a) : best;
}

}  // namespace clearance::bench
