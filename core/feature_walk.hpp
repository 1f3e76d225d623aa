// From the features that were closest last time to those that are closest now, by their boundaries
// alone.
//
// Each step is a round of the active-set loop (delta, alpha, lambda) without its points: for the
// four pairs of features that a moving pair is nearly always in, straight-line code decides whether
// they are closest still, and if not, which neighbour takes over. Nothing guarantees progress here,
// so the steps are counted, and what they do not settle is the loop's. The proof falls out of the
// last step: a vertex whose every edge falls away along the separating direction, an edge whose
// both facets do, a facet: each is the farthest of its body.
#pragma once

#include "core/convex_polyhedron.hpp"
#include "core/distance.hpp"
#include "core/pose.hpp"

namespace clearance {

// The closest points of two cores and the direction between them; everything but own_b in frame A.
struct ClosestFeatures {
  Vec3 point_a, point_b;
  Vec3 own_b;     // point_b in frame B
  Vec3 normal;    // unit, from A to B
  double apart;   // m: |point_b - point_a|
  double proved;  // m: how far apart the direction proves the bodies, before the slack of Precision
  int steps;
};

// Moves the features of `state` as far as it gets; the points of `state` are not looked at. False:
// not settled, because rounding cannot tell, or the pair is another (two facets, two unbounded
// bodies), or the steps ran out.
[[nodiscard]] bool walk_features(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                 const RelativePose& a_from_b, TrackingState& state,
                                 ClosestFeatures& closest) noexcept;

}  // namespace clearance
