// Feature tracking moves from the features that were closest in the last query to those that are
// closest now, by their boundaries alone. This is the method of Lin and Canny (1991) and of V-Clip
// (Mirtich 1998). Each closest point lies in the Voronoi region of the other body's feature. A
// violated boundary of a region names the next feature.
//
// A transition is an iteration of the active set (delta, alpha, lambda) without its points. For
// every pair of features, straight-line code decides whether they satisfy the KKT conditions, and
// if not, which neighbour takes over. Nothing guarantees progress here, so transitions are counted,
// and the active-set iteration answers the queries that they leave open. The last transition yields
// the certificate. A vertex is the support point of its body if all its edges have negative
// directional derivatives along the separating direction. An edge is the support set if its two
// facets have. If features are parallel within tolerance, the points of the last query choose among
// all closest ones (core/feature_tracking/parallel_transitions-inl.hpp).
#pragma once

#include "core/convex_body.hpp"
#include "core/distance_result.hpp"
#include "core/pose.hpp"

namespace clearance {

enum class TrackingEnd : std::uint8_t {
  kUndecided,    // rounding cannot tell, or both bodies are unbounded
  kExhausted,    // too many transitions
  kUncertified,  // these are the closest points, but the direction between them bounds the
                 // distance less closely than the bodies' precision allows
  kCertified,    // the bodies are disjoint, and the bounds are as close as rounding allows
};

// Are the features where tracking ended the closest ones?
[[nodiscard]] constexpr bool are_closest(TrackingEnd end) noexcept {
  return end == TrackingEnd::kUncertified || end == TrackingEnd::kCertified;
}

// The transitions that a query has made so far.
struct TransitionsMade {
  int transitions = 0, parallel_transitions = 0;
};

[[nodiscard]] inline bool has_feature(const ConvexBody& body, FeatureKind kind,
                                      const TrackingState::Side& side) noexcept {
  return static_cast<std::uint32_t>(side.feature) < body.features[static_cast<std::size_t>(kind)];
}
[[nodiscard]] inline bool exists(const ConvexBody& body, const TrackingState::Side& side) noexcept {
  return side.kind <= FeatureKind::kFacet && has_feature(body, side.kind, side);
}

// Is the first transition straight-line code? It is for two vertices, for two edges, and for a
// vertex with an edge or facet, if the bodies were disjoint. The sum of the two kinds shows this: 0
// + 0, 0 + 1, 1 + 1 and 0 + 2. The bodies themselves are not examined.
[[nodiscard]] inline bool has_straight_features(const TrackingState& state) noexcept {
  return !state.a.penetrating && static_cast<int>(state.a.kind) + static_cast<int>(state.b.kind) <=
                                     static_cast<int>(FeatureKind::kFacet);
}
// Are two facets the features of disjoint bodies? The bodies themselves are not examined.
[[nodiscard]] inline bool has_facets(const TrackingState& state) noexcept {
  return !state.a.penetrating && state.a.kind == FeatureKind::kFacet &&
         state.b.kind == FeatureKind::kFacet;
}
// Do the bodies have these features, and is one of them bounded?
[[nodiscard]] inline bool can_be_tracked(const ConvexBody& a, const ConvexBody& b,
                                         const TrackingState& state) noexcept {
  return (a.bounded() || b.bounded()) && exists(a, state.a) && exists(b, state.b);
}

// The sum of both bodies' classes: see QueryClass.
[[nodiscard]] inline std::uint32_t query_class(const ConvexBody& a, const ConvexBody& b) noexcept {
  return static_cast<std::uint32_t>(a.query_class) + static_cast<std::uint32_t>(b.query_class);
}
inline constexpr std::uint32_t kTwoPoints = 4;

// Moves the features of `state` by transitions until they are closest. If they are, `result` (of
// the polyhedra, without radii) and the points of `state` belong to them.
[[nodiscard]] TrackingEnd track_features(const ConvexBody& a, const ConvexBody& b,
                                         const RelativePose& a_from_b, TrackingState& state,
                                         DistanceResult& result) noexcept;

}  // namespace clearance
