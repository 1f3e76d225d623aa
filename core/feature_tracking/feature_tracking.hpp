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

#include "core/model/query.hpp"

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

// Moves the features of the state by transitions until they are closest. If they are, `answer` and
// the points of the state belong to them.
[[nodiscard]] TrackingEnd track_features(const Query& query, Answer& answer) noexcept;

}  // namespace clearance
