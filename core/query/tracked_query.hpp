// distance() for a batch: it may have taken a pair's first transition itself, and makes so many
// queries that finding the machine's vectors counts, which is done once for many queries.
#pragma once

#include "core/distance_result.hpp"
#include "core/feature_walk/feature_walk.hpp"
#include "core/pose.hpp"

namespace clearance {

// A query of a pair whose walk has this behind it.
using TrackedQuery = DistanceResult (*)(const ConvexBody& a, const ConvexBody& b,
                                        const Pose& world_from_a, const Pose& world_from_b,
                                        TrackingState& state, WalkStart start);
[[nodiscard]] TrackedQuery tracked_query() noexcept;

}  // namespace clearance
