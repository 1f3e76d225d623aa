// From the features that were closest last time to those that are closest now, by their boundaries
// alone.
//
// Each step is a round of the active-set loop (delta, alpha, lambda) without its points: for every
// pair of features, straight-line code decides whether they are closest still, and if not, which
// neighbour takes over. Nothing guarantees progress here, so the steps are counted, and what they
// do not settle is the loop's. The proof falls out of the last step: a vertex whose every edge
// falls away along the separating direction, an edge whose both facets do, a facet: each is the
// farthest of its body. Where features are parallel as far as rounding can tell, the points of the
// last query choose among all closest ones (core/feature_walk/parallel_steps-inl.hpp).
#pragma once

#include "core/convex_polyhedron.hpp"
#include "core/distance_result.hpp"
#include "core/pose.hpp"

namespace clearance {

enum class WalkEnd : std::uint8_t {
  kLost,     // not settled, because rounding cannot tell, or both bodies are unbounded, or the
             // steps ran out
  kSettled,  // these are the closest points; the direction between them proves less than the
             // bodies' precision allows
  kProved,   // the bodies are apart, and the bounds as close as rounding lets them be
};

[[nodiscard]] inline bool exists(const ConvexPolyhedron& body,
                                 const TrackingState::Side& side) noexcept {
  return side.dimension <= 2 &&
         static_cast<std::uint32_t>(side.feature) < body.features[side.dimension];
}

// Are the state's features of kinds that straight-line code judges, of bodies that were apart? Does
// not look at the bodies.
[[nodiscard]] inline bool is_straight(const TrackingState& state) noexcept {
  return !state.a.deep && state.a.dimension + state.b.dimension <= 2;
}
// Have the bodies these features, and is one of them bounded?
[[nodiscard]] inline bool can_be_walked(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                        const TrackingState& state) noexcept {
  return (a.bounded() || b.bounded()) && exists(a, state.a) && exists(b, state.b);
}

// Moves the features of `state` as far as it gets. Unless it is lost, `result` (of the cores,
// without radii) and the points of `state` are those of the features it ends at.
[[nodiscard]] WalkEnd walk_features(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                    const RelativePose& a_from_b, TrackingState& state,
                                    DistanceResult& result) noexcept;

// For bodies that overlapped in the last query. True: it is proved how deep they do, or that they
// do not any more. False: nothing is, and `state` and `result` are as they were.
[[nodiscard]] bool walk_overlap(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                const RelativePose& a_from_b, TrackingState& state,
                                DistanceResult& result) noexcept;

}  // namespace clearance
