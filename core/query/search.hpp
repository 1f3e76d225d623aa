// What the walk leaves open: the loop, the robust path, the depth (core/README.md).
#pragma once

#include "core/distance_result.hpp"
#include "core/pose.hpp"

namespace clearance {

// Is it finite, and are the frames no more than kLargestCoordinate apart?
[[nodiscard]] bool is_good(const RelativePose& pose) noexcept;
// The answer of one that is not.
[[nodiscard]] DistanceResult of_bad_pose() noexcept;

// distance() by the loop from the features of the state on, and if need be by the robust path; if
// `depth`, of bodies that overlap by the depth as well.
[[nodiscard]] DistanceResult by_search(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                       const RelativePose& a_from_b, TrackingState& state,
                                       bool depth) noexcept;

// distance() of bodies that overlapped in the last query.
[[nodiscard]] DistanceResult by_depth(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                      const RelativePose& a_from_b, TrackingState& state) noexcept;

}  // namespace clearance
