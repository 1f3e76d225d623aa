// The penetration depth of two bodies as a DistanceResult, tracked.
#pragma once

#include <optional>

#include "core/convex_body.hpp"
#include "core/distance_result.hpp"
#include "core/penetration/depth.hpp"
#include "core/pose.hpp"

namespace clearance {

// For bodies that touched or penetrated each other in the last query: answers this query if they
// certainly penetrate. False: that is not certified; `result` is not touched, and the features of
// `state` are where a search should begin. `found` gets the depth if it was looked for.
[[nodiscard]] bool track_penetration(const ConvexBody& a, const ConvexBody& b,
                                     const RelativePose& a_from_b, TrackingState& state,
                                     DistanceResult& result, std::optional<Depth>& found) noexcept;

// For a result of the polyhedra, without radii, whose lower bound is not positive. Bounds it from
// below, and finds the depth if the polyhedra penetrate. `state` holds the last features and gets
// the new ones. `known`: the depth, if it is known already.
void measure_penetration(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                         TrackingState& state, DistanceResult& result,
                         const std::optional<Depth>& known) noexcept;

}  // namespace clearance
