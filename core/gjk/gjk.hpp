// The slower, robust method, for queries in which rounding kept the active-set iteration from
// certifying its result.
#pragma once

#include "core/active_set/active_feature.hpp"
#include "core/distance_result.hpp"
#include "core/model/error_bounds.hpp"
#include "core/pose.hpp"

namespace clearance {

// Tightens `result`, the result of the active-set iteration in frame A, as far as doubles allow. A
// body is the hull of the vertices that the model stores. So rounded facets, edges and vertices
// cannot disagree. The closest point of the Minkowski difference's simplex (Gilbert, Johnson and
// Keerthi 1988) is computed in double-double. The bounds never get worse. `a` and `b` keep their
// features and end at the witness points.
void refine(ActiveFeature& a, ActiveFeature& b, const RelativePose& a_from_b, const Precision& p,
            DistanceResult& result) noexcept;

}  // namespace clearance
