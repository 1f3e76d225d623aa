// How far apart the features of two unbounded bodies are that are closest far away.
#pragma once

#include "core/active_set/active_feature.hpp"
#include "core/model/error_bounds.hpp"

namespace clearance {

// An upper bound of the distance, m, but for Precision::slack: upper + beyond.
struct FarApart {
  double upper = kInfinity;
  double beyond = 0.0;
};

// Where features are closest far away, how far they are apart is known better than where: it is how
// far they are along the direction across two edges, or along a facet's exact one from an edge,
// measured near the bodies' origins. Infinity where they are other ones, or not for certain within
// their ends.
[[nodiscard]] FarApart far_apart(const ActiveFeature& a, const ActiveFeature& b,
                                 const Precision& p) noexcept;

}  // namespace clearance
