// The distance of two convex bodies, at least one of which is curved. Tracked: each call starts
// where the last one ended.
//
// Maximises n.(b - a) over unit directions n, b and a being the bodies' support points along -n and
// n. Every direction bounds the distance from below, and every pair of points from above.
#pragma once

#include "core/distance_result.hpp"
#include "core/pose.hpp"

namespace clearance {

// noexcept, no heap, deterministic. Any state and any pose are accepted. DistanceResult explains
// the answer. `depth`: as in DistanceOptions. Both bodies may be polyhedra if one of them is
// bounded, but distance() answers these faster and with closer bounds.
[[nodiscard]] DistanceResult curved_distance(const ConvexBody& a, const ConvexBody& b,
                                             const RelativePose& a_from_b, TrackingState& state,
                                             bool depth = true) noexcept;

}  // namespace clearance
