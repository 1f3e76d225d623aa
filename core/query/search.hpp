// Queries that feature tracking leaves open: the active-set iteration, GJK in double-double
// arithmetic, and the penetration depth (core/README.md).
#pragma once

#include "core/distance_result.hpp"
#include "core/model/bad_pose.hpp"
#include "core/pose.hpp"

namespace clearance {

// distance() by the active-set iteration, starting from the features of the state, and by GJK if
// the iteration certifies too little. If `depth`, bodies that penetrate each other get their
// penetration depth as well.
[[nodiscard]] DistanceResult search_distance(const ConvexBody& a, const ConvexBody& b,
                                             const RelativePose& a_from_b, TrackingState& state,
                                             bool depth) noexcept;

// distance() of a pair with a curved body.
[[nodiscard]] DistanceResult curved_pair_distance(const ConvexBody& a, const ConvexBody& b,
                                                  const RelativePose& a_from_b,
                                                  TrackingState& state, bool depth) noexcept;
// The same by poses.
[[nodiscard]] DistanceResult curved_pair_distance(const ConvexBody& a, const ConvexBody& b,
                                                  const Pose& world_from_a,
                                                  const Pose& world_from_b,
                                                  TrackingState& state) noexcept;

// distance() of bodies that penetrated each other in the last query.
[[nodiscard]] DistanceResult penetrating_distance(const ConvexBody& a, const ConvexBody& b,
                                                  const RelativePose& a_from_b,
                                                  TrackingState& state) noexcept;

}  // namespace clearance
