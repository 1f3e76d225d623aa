// From the depth of two overlapping bodies to a DistanceResult, tracked.
#pragma once

#include "core/convex_polyhedron.hpp"
#include "core/distance_result.hpp"
#include "core/pose.hpp"

namespace clearance {

// For bodies that overlapped in the last query: settles this one, if they do still. False: not
// proved; `result` is not touched, and the features of `state` are where a search should begin.
[[nodiscard]] bool still_overlapping(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                     const RelativePose& a_from_b, TrackingState& state,
                                     DistanceResult& result) noexcept;

// For a result (cores only, without radii) whose lower bound is not positive: bounds it from below,
// and where the cores overlap, finds their depth. `state` holds the last features, and is moved on.
void measure_overlap(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                     const RelativePose& a_from_b, TrackingState& state,
                     DistanceResult& result) noexcept;

}  // namespace clearance
