// A pair whose features are the closest no longer goes on from what its lane has found out: which
// neighbour takes over, as a step of core/feature_walk-inl.hpp would have said.
#pragma once

#include "core/batch_block.hpp"
#include "core/distance.hpp"

namespace clearance {

// How far a walk is: what core/feature_walk-inl.hpp counts.
struct WalkStart {
  int steps = 0, levels = 0;
};

// The step from the features of `state`, of the given kind, to the neighbour that a lane names. No
// step: the lane could not tell, and they are for distance().
[[nodiscard]] WalkStart depart(FeatureKind kind, const ConvexPolyhedron& a,
                               const ConvexPolyhedron& b, const FailedLanes& of, std::size_t lane,
                               TrackingState& state) noexcept;

// distance() from there on, as compiled for the vectors that the machine has.
using TrackedQuery = DistanceResult (*)(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                        const Pose& world_from_a, const Pose& world_from_b,
                                        TrackingState& state, WalkStart start);
[[nodiscard]] TrackedQuery tracked_query() noexcept;

}  // namespace clearance
