// Newton's method on the direction, as one query: see newton-inl.hpp.
#pragma once

#include "core/curved/tracking.hpp"
#include "core/pose.hpp"

namespace clearance {

// From the state's direction and pieces, or from the line between the frames' origins. True: the
// bounds are tight, and `result` is the answer. False: the bodies overlap or nearly touch, or one of
// them is unbounded, or rounding leaves the bounds too wide, or many pieces are equally near; the
// state is then a hint for the search of direction_search.hpp. The state must have no nonsense in it.
[[nodiscard]] bool newton_distance(const ConvexBody& a, const ConvexBody& b,
                                   const RelativePose& a_from_b, CurvedTrackingState& state,
                                   DistanceResult& result) noexcept;

// The same for relative_pose(world_from_a, world_from_b), to the bit, and faster; any state is
// accepted. False: `a_from_b` is that relative pose, for open_distance().
[[nodiscard]] bool newton_distance(const ConvexBody& a, const ConvexBody& b,
                                   const Pose& world_from_a, const Pose& world_from_b,
                                   TrackingState& state, DistanceResult& result,
                                   RelativePose& a_from_b) noexcept;

}  // namespace clearance
