// Feature tracking: from the features that were closest last time to those that are closest now, by
// their boundaries alone.
//
// A transition is an iteration of the active set (delta, alpha, lambda) without its points: for
// every pair of features straight-line code decides whether they satisfy the KKT conditions, and if
// not, which neighbour takes over. Nothing guarantees progress here, so transitions are counted,
// and what they do not settle is left to the active-set iteration. The certificate falls out of the
// last one: a vertex whose edges all have negative directional derivatives along the separating
// direction, an edge whose two facets have, a facet: each is its body's support there. Where
// features are parallel within tolerance, the points of the last query choose among all closest
// ones (core/feature_walk/parallel_steps-inl.hpp).
#pragma once

#include "core/convex_body.hpp"
#include "core/distance_result.hpp"
#include "core/pose.hpp"

namespace clearance {

enum class WalkEnd : std::uint8_t {
  kUndecided,    // rounding cannot tell, or both bodies are unbounded, or too many transitions
  kUncertified,  // these are the closest points; the direction between them bounds the distance
                 // worse than the bodies' precision allows
  kCertified,    // the bodies are apart, and the bounds as close as rounding lets them be
};

// How many transitions a walk has behind it.
struct WalkStart {
  int transitions = 0, parallel_transitions = 0;
};

[[nodiscard]] inline bool exists(const ConvexBody& body, const TrackingState::Side& side) noexcept {
  return side.kind <= FeatureKind::kFacet && static_cast<std::uint32_t>(side.feature) <
                                                 body.features[static_cast<std::size_t>(side.kind)];
}

// Two vertices, two edges, or a vertex and an edge or facet, of bodies that were apart: the first
// transition from there is straight-line code. Does not look at the bodies.
[[nodiscard]] inline bool is_straight(const TrackingState& state) noexcept {
  return !state.a.penetrating && static_cast<int>(state.a.kind) + static_cast<int>(state.b.kind) <=
                                     static_cast<int>(FeatureKind::kFacet);
}
// Have the bodies these features, and is one of them bounded?
[[nodiscard]] inline bool can_be_walked(const ConvexBody& a, const ConvexBody& b,
                                        const TrackingState& state) noexcept {
  return (a.bounded() || b.bounded()) && exists(a, state.a) && exists(b, state.b);
}

// Moves the features of `state` as far as it gets. Unless it is undecided, `result` (of the
// polyhedra, without radii) and the points of `state` are those of the features it ends at.
[[nodiscard]] WalkEnd walk_features(const ConvexBody& a, const ConvexBody& b,
                                    const RelativePose& a_from_b, TrackingState& state,
                                    DistanceResult& result) noexcept;

// For bodies that penetrated each other in the last query. True: their depth is certified, or that
// they do not any more. False: nothing is, and `state` and `result` are as they were.
[[nodiscard]] bool walk_penetration(const ConvexBody& a, const ConvexBody& b,
                                    const RelativePose& a_from_b, TrackingState& state,
                                    DistanceResult& result) noexcept;

}  // namespace clearance
