// Newton's method on the direction, as one query: see newton-inl.hpp.
#pragma once

#include "core/curved/tracking.hpp"
#include "core/pose.hpp"

namespace clearance {

// From the state's direction and pieces, or from the line between the frames' origins. True: the
// bounds are tight, and `result` is the answer. False: the bodies overlap or nearly touch, or
// another one is unbounded, or rounding leaves the bounds too wide, or many pieces are as near as
// each other; the state is then a hint for the search of direction_search.hpp, if anything.
[[nodiscard]] bool newton_distance(const ConvexBody& a, const ConvexBody& b,
                                   const RelativePose& a_from_b, CurvedTrackingState& state,
                                   DistanceResult& result) noexcept;

// The same for relative_pose(world_from_a, world_from_b), to the bit, and faster. What it leaves
// open `otherwise` answers, from the same state.
using OtherDistance = DistanceResult (*)(const ConvexBody& a, const ConvexBody& b,
                                         const RelativePose& a_from_b, TrackingState& state,
                                         bool depth) noexcept;
[[nodiscard]] DistanceResult newton_distance(const ConvexBody& a, const ConvexBody& b,
                                             const Pose& world_from_a, const Pose& world_from_b,
                                             TrackingState& state,
                                             OtherDistance otherwise) noexcept;

}  // namespace clearance
