// A pair whose features are the closest no longer goes on from what its lane has found out: which
// neighbour takes over, as transition() of core/feature_walk/steps-inl.hpp would have said.
#pragma once

#include "core/batch/block.hpp"
#include "core/distance_result.hpp"
#include "core/query/tracked_query.hpp"

namespace clearance {

// The transition from the features of `state` to the neighbour that a lane names. None: the lane
// could not tell, and the features are left to distance().
[[nodiscard]] WalkStart to_next_feature(FeaturePair features, const ConvexBody& a,
                                        const ConvexBody& b, const FailedLanes& of,
                                        std::size_t lane, TrackingState& state) noexcept;

}  // namespace clearance
