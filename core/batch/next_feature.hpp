// For a pair whose features are no longer the closest: moves to the neighbour that its lane has
// found. The function transition() of core/feature_tracking/transitions-inl.hpp would have moved to
// the same neighbour.
#pragma once

#include "core/batch/block.hpp"
#include "core/distance_result.hpp"
#include "core/query/entries.hpp"

namespace clearance {

// The transition from the features of `state` to the neighbour that a lane names. None: the lane
// could not tell, and the features are left to distance().
[[nodiscard]] TransitionsMade to_next_feature(FeaturePair features, const ConvexBody& a,
                                              const ConvexBody& b, const FailedLanes& of,
                                              std::size_t lane, TrackingState& state) noexcept;

}  // namespace clearance
