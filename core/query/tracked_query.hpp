// distance() for a batch, which may have made the first transitions of a pair itself. A batch makes
// many queries in a row, so it looks up the machine's vector width once for all of them.
#pragma once

#include "core/distance_result.hpp"
#include "core/feature_tracking/feature_tracking.hpp"
#include "core/pose.hpp"

namespace clearance {

// A query of a pair that has made the transitions of `start`.
using TrackedQuery = DistanceResult (*)(const ConvexBody& a, const ConvexBody& b,
                                        const Pose& world_from_a, const Pose& world_from_b,
                                        TrackingState& state, TransitionsMade start);
[[nodiscard]] TrackedQuery tracked_query() noexcept;

}  // namespace clearance
