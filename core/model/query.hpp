// A query, as the methods of the rooms above get it, and what they find.
#pragma once

#include "core/convex_body.hpp"
#include "core/distance_result.hpp"
#include "core/pose.hpp"

namespace clearance {

// `Placement` is RelativePose, or RelativePose4 in code that is compiled once per vector width.
template <class Placement>
struct QueryAt {
  const ConvexBody& a;
  const ConvexBody& b;
  const Placement& a_from_b;
  TrackingState& state;
  bool depth = true;  // as in DistanceOptions
};
using Query = QueryAt<RelativePose>;

// The result for the bodies without their radii. Its status says whether the bounds have converged:
// kConverged, kIterationLimit, or kDepthNotAsked. finish() makes a result of it
// (core/model/finish.hpp).
using Answer = DistanceResult;

// Does the side of a state name a vertex, an edge or a facet of the body?
[[nodiscard]] inline bool exists(const ConvexBody& body, const TrackingState::Side& side) noexcept {
  return side.kind <= FeatureKind::kFacet && static_cast<std::uint32_t>(side.feature) <
                                                 body.features[static_cast<std::size_t>(side.kind)];
}

template <class Placement>
[[nodiscard]] bool has_features(const QueryAt<Placement>& q) noexcept {
  return exists(q.a, q.state.a) && exists(q.b, q.state.b);
}

// Is it a sphere without its radius?
[[nodiscard]] inline bool is_point(const ConvexBody& body) noexcept {
  return body.features[0] == 1 && body.features[1] == 0;
}

// m: the size of a pair, in which roundings are counted. `between`: the length of the translation.
[[nodiscard]] inline double size_of(const ConvexBody& a, const ConvexBody& b,
                                    double between) noexcept {
  return (a.bounding_radius + b.bounding_radius) + between;
}

}  // namespace clearance
