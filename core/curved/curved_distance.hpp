// How far apart are two convex bodies, curved or not? Tracked: each call starts where the last one
// ended.
//
// Maximises n.(b - a) over unit directions n, b and a being the bodies' support points along -n and
// n. Every direction bounds the distance from below, and every pair of points from above.
#pragma once

#include "core/curved/curved_body.hpp"
#include "core/curved/direction_search.hpp"
#include "core/distance_result.hpp"
#include "core/pose.hpp"

namespace clearance {

// What a pair remembers: a hint and never a fact.
struct CurvedTrackingState {
  Vec3 normal = Vec3::Zero();  // frame A; 0: none
  ActivePieces active;
  // Of the last query: the point of B without its radius, in frame B; and where the bodies overlap,
  // a point of both, frame A.
  Vec3 own_point_on_b = Vec3::Zero(), shared = Vec3::Zero();
};

// noexcept, no heap, deterministic. Any state is accepted. See DistanceResult for what the answer
// says. Unbounded bodies are half-spaces, and one of a pair at most; of others nothing is known.
[[nodiscard]] DistanceResult curved_distance(const CurvedBody& a, const CurvedBody& b,
                                             const RelativePose& a_from_b,
                                             CurvedTrackingState& state) noexcept;

}  // namespace clearance
