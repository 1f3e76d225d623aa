// distance() for those who have begun a pair's walk themselves, and ask so often that finding the
// vectors that the machine has counts: once for many queries.
#pragma once

#include "core/distance_result.hpp"
#include "core/pose.hpp"

namespace clearance {

// How far a walk is: what core/feature_walk/steps-inl.hpp counts.
struct WalkStart {
  int steps = 0, levels = 0;
};

// From there on, as compiled for these vectors.
using TrackedQuery = DistanceResult (*)(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                        const Pose& world_from_a, const Pose& world_from_b,
                                        TrackingState& state, WalkStart start);
[[nodiscard]] TrackedQuery tracked_query() noexcept;

}  // namespace clearance
