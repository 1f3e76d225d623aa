// The 'alpha' step: how far a body's point may move before a new facet becomes active (§3.3.1.3,
// §3.6.1).
//
// Since x lies in the feature, only the boundary of the feature can block. It consists of a facet's
// edges, an edge's ends, or all facets for the inside.
#pragma once

#include <cassert>

#include "core/active_set/active_feature.hpp"

namespace clearance {

struct Alpha {
  double fraction = 1.0;  // of the intended move, in [0, 1]; 1 means that nothing blocks
  // The index of the facet, edge or vertex that blocks and becomes the active feature.
  std::int32_t blocking = kNone;
};

namespace alpha_case {

// The distance to a boundary over the speed towards it. A boundary that x has already crossed by
// rounding blocks at once.
inline double fraction(double gap, double speed) noexcept { return gap > 0.0 ? gap / speed : 0.0; }

inline Alpha from_inside(const ActiveFeature& side, const Vec3& move) noexcept {
  Alpha best;
  const auto& facets = side.body().facets;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const double speed = facets[i].normal.dot(move);
    if (!(speed > 0.0)) continue;
    const double f = fraction(facets[i].offset - facets[i].normal.dot(side.point_L()), speed);
    if (f < best.fraction) best = {f, static_cast<std::int32_t>(i)};
  }
  return best;
}

inline Alpha within_facet(const ActiveFeature& side, const Vec3& move) noexcept {
  Alpha best;
  const Facet& facet = side.facet();
  for (std::int32_t i = 0; i < facet.limits; ++i) {
    const FacetLimit boundary = side.body().limit_of(facet, i);
    const double speed = -boundary.inward.dot(move);
    if (!(speed > 0.0)) continue;
    const double gap = boundary.inward.dot(side.point_L()) - boundary.offset;
    if (!(gap < best.fraction * speed)) continue;
    best = {fraction(gap, speed), side.body().facet_edges[facet.first_side + i].edge};
  }
  return best;
}

inline Alpha along_edge(const ActiveFeature& side, const Vec3& move) noexcept {
  const Edge& edge = side.edge();
  const double speed = edge.direction.dot(move);
  const double at = (side.point_L() - edge.point).dot(edge.direction);
  if (at + speed > edge.end && speed > 0.0) return {fraction(edge.end - at, speed), edge.vertex[1]};
  if (at + speed < edge.begin && speed < 0.0) {
    return {fraction(at - edge.begin, -speed), edge.vertex[0]};
  }
  return {};
}

}  // namespace alpha_case

[[nodiscard]] inline Alpha alpha(const ActiveFeature& side, const Vec3& move_in_a) noexcept {
  if (side.feature() == FeatureKind::kVertex) return {};
  const Vec3 move = side.direction_A_to_L(move_in_a);
  if (side.feature() == FeatureKind::kEdge) return alpha_case::along_edge(side, move);
  if (side.feature() == FeatureKind::kFacet) return alpha_case::within_facet(side, move);
  return alpha_case::from_inside(side, move);
}

// Makes the move. If it was blocked, the blocking feature becomes the active one.
inline void advance(ActiveFeature& side, const Vec3& move_in_a, const Alpha& step) noexcept {
  assert(!(step.fraction < 0.0) && !(step.fraction > 1.0));
  if (side.feature() == FeatureKind::kVertex) return;
  const Vec3 to = side.point_L() + step.fraction * side.direction_A_to_L(move_in_a);
  if (side.feature() == FeatureKind::kEdge) {
    if (step.blocking != kNone) return side.place_at_vertex(step.blocking);
    return side.place_on_edge(side.index(), to);
  }
  if (side.feature() == FeatureKind::kFacet) {
    if (step.blocking != kNone) return side.place_on_edge(step.blocking, to);
    return side.place_on_facet(side.index(), to);
  }
  if (step.blocking != kNone) {
    return side.place_on_facet(facet_under(side.body(), step.blocking, to), to);
  }
  side.place_inside(to);
}

}  // namespace clearance
