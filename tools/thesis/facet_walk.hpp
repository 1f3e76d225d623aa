// The facet walk of §3.6.2: finds the neighbours of a facet by following its boundary; each step
// searches all half-spaces.
#pragma once

#include "tools/thesis/adjacency.hpp"

namespace clearance::bench {

// O(N^2). In doubles and with the tie at a vertex of more than three facets decided by index: at
// such vertices it finds neighbours that share only a point.
[[nodiscard]] Neighbours walk_facets(std::span<const HalfSpace> rows);

}  // namespace clearance::bench
