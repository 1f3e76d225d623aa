// A pair whose features are the closest no longer goes on from what its lane has found out: which
// neighbour takes over, as a step of core/feature_walk/steps-inl.hpp would have said.
#pragma once

#include "core/batch/block.hpp"
#include "core/distance_result.hpp"
#include "core/query/tracked_query.hpp"

namespace clearance {

// The step from the features of `state`, of the given kind, to the neighbour that a lane names. No
// step: the lane could not tell, and they are for distance().
[[nodiscard]] WalkStart depart(FeatureKind kind, const ConvexPolyhedron& a,
                               const ConvexPolyhedron& b, const FailedLanes& of, std::size_t lane,
                               TrackingState& state) noexcept;

}  // namespace clearance
