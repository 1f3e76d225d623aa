// The witness points of two bodies that penetrate each other.
#pragma once

#include "core/convex_body.hpp"
#include "core/distance_result.hpp"
#include "core/penetration/depth.hpp"
#include "core/pose.hpp"

namespace clearance {

// Finds the points that meet when B has been moved by the depth `found`, clear of A. Writes them to
// `result`, in frame A, whose distance and normal are known, and to `state`, which holds the last
// features.
void place_witnesses(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                     const Depth& found, TrackingState& state, DistanceResult& result) noexcept;

}  // namespace clearance
