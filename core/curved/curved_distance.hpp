// How far apart are two convex bodies, curved or not? Tracked: each call starts where the last one
// ended.
//
// Maximises n.(b - a) over unit directions n, b and a being the bodies' support points along -n and
// n. Every direction bounds the distance from below, and every pair of points from above.
#pragma once

#include "core/curved/tracking.hpp"
#include "core/pose.hpp"

namespace clearance {

// noexcept, no heap, deterministic. Any state is accepted. See DistanceResult for what the answer
// says; the pose has to be a good one. `depth`: as DistanceOptions has it. Both bodies may be
// polyhedra, one of them bounded, but distance() answers these faster and with closer bounds.
[[nodiscard]] DistanceResult curved_distance(const ConvexBody& a, const ConvexBody& b,
                                             const RelativePose& a_from_b, TrackingState& state,
                                             bool depth = true) noexcept;
// The same, and a point of both bodies where they overlap.
[[nodiscard]] DistanceResult curved_distance(const ConvexBody& a, const ConvexBody& b,
                                             const RelativePose& a_from_b,
                                             CurvedTrackingState& state,
                                             bool depth = true) noexcept;
// The rest of a query by poses that newton_distance() (newton.hpp) has left open, depth included.
[[nodiscard]] DistanceResult open_distance(const ConvexBody& a, const ConvexBody& b,
                                           const RelativePose& a_from_b,
                                           TrackingState& state) noexcept;

}  // namespace clearance
