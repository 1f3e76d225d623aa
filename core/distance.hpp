// The distance of two convex bodies. Tracked: each call starts where the last one ended.
//
// Minimises |b - a| over a in A, b in B (§3.2). Feature tracking moves from the last closest
// features to the present ones (V-Clip, Lin-Canny; core/feature_tracking). The active-set QP of
// core/active_set/dqp3.hpp decides the queries that tracking leaves open (§3.3, §3.4). Every answer
// is certified: a separating direction bounds it from below (weak duality, §3.2), and witness
// points on the bodies bound it from above. Everything is in frame A, in metres.
#pragma once

#include "core/convex_body.hpp"
#include "core/distance_result.hpp"
#include "core/pose.hpp"

namespace clearance {

struct DistanceOptions {
  // False: the query does not compute the penetration depth, which takes most of the time if bodies
  // overlap. Bodies that are not certified disjoint then get the status kDepthNotAsked, and their
  // lower bound may be -infinity.
  bool depth = true;
};
static_assert(sizeof(DistanceOptions) == 1 && alignof(DistanceOptions) == 1);

// noexcept, no heap, deterministic. Any state is accepted.
[[nodiscard]] DistanceResult distance(const ConvexBody& a, const ConvexBody& b,
                                      const RelativePose& a_from_b, TrackingState& state,
                                      const DistanceOptions& options = {}) noexcept;

// The same result, bit for bit, as the query by relative_pose(world_from_a, world_from_b).
[[nodiscard]] DistanceResult distance(const ConvexBody& a, const ConvexBody& b,
                                      const Pose& world_from_a, const Pose& world_from_b,
                                      TrackingState& state) noexcept;

}  // namespace clearance
