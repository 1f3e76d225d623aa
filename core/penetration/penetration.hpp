// The penetration depth of two bodies as a DistanceResult, tracked.
#pragma once

#include "core/convex_body.hpp"
#include "core/distance_result.hpp"
#include "core/pose.hpp"

namespace clearance {

// For bodies that penetrated each other in the last query: answers this query if they still do.
// False: that is not certified; `result` is not touched, and the features of `state` are where a
// search should begin.
[[nodiscard]] bool track_penetration(const ConvexBody& a, const ConvexBody& b,
                                     const RelativePose& a_from_b, TrackingState& state,
                                     DistanceResult& result) noexcept;

// For a result of the polyhedra, without radii, whose lower bound is not positive. Bounds it from
// below, and finds the depth if the polyhedra penetrate. `state` holds the last features and gets
// the new ones.
void measure_penetration(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                         TrackingState& state, DistanceResult& result) noexcept;

}  // namespace clearance
