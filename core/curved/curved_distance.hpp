// The distance of two convex bodies, one of which is curved at least. Tracked: each call starts
// where the last one ended.
//
// Maximises n.(b - a) over unit directions n, b and a being the bodies' support points along -n and
// n. Every direction bounds the distance from below, and every pair of points from above.
#pragma once

#include "core/distance_result.hpp"
#include "core/pose.hpp"

namespace clearance {

// noexcept, no heap, deterministic. Any state and any pose are accepted. See DistanceResult for
// what the answer says. `depth`: as DistanceOptions has it. Both bodies may be polyhedra, one of
// them bounded, but distance() answers these faster and with closer bounds.
[[nodiscard]] DistanceResult curved_distance(const ConvexBody& a, const ConvexBody& b,
                                             const RelativePose& a_from_b, TrackingState& state,
                                             bool depth = true) noexcept;

// The same for relative_pose(world_from_a, world_from_b), to the bit, and faster.
[[nodiscard]] DistanceResult curved_distance(const ConvexBody& a, const ConvexBody& b,
                                             const Pose& world_from_a, const Pose& world_from_b,
                                             TrackingState& state) noexcept;

}  // namespace clearance
