// The slower, robust path, taken where rounding kept the active-set iteration from certifying its
// result.
#pragma once

#include "core/active_set/active_feature.hpp"
#include "core/distance_result.hpp"
#include "core/model/error_bounds.hpp"
#include "core/pose.hpp"

namespace clearance {

// Tightens `result` (a conclusion of the fast path, all in the common frame) as far as doubles
// allow. Works on vertices alone, as the hull of the points that the model stores, so that there is
// no disagreement between rounded facets, edges and vertices; the closest point of the
// Minkowski difference's simplex (Gilbert, Johnson, Keerthi) is computed in twice the precision.
// Bounds only ever improve. The sides end at the witness points, by the features they had.
void refine(ActiveFeature& a, ActiveFeature& b, const RelativePose& a_from_b, const Precision& p,
            DistanceResult& result) noexcept;

}  // namespace clearance
