// The facet walk of §3.6.2: finds the neighbours of a facet by following its boundary; each step
// searches all half-spaces.
#pragma once

#include "tools/bench/thesis/adjacency.hpp"

namespace clearance::bench {

// The walk takes O(N^2) in doubles. At a vertex of more than three facets the tie is decided by
// index, so it finds neighbours there that share only a point.
[[nodiscard]] Neighbours walk_facets(std::span<const HalfSpace> rows);

}  // namespace clearance::bench
