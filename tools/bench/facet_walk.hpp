// §3.6.2: a facet's neighbours by walking around it, every step a search through all half-spaces.
#pragma once

#include "tools/bench/adjacency.hpp"

namespace clearance::bench {

// O(N^2). In doubles and with the tie at a vertex of more than three facets decided by index: at
// such vertices it names neighbours that share a point only.
[[nodiscard]] Neighbours walk_facets(std::span<const HalfSpace> rows);

}  // namespace clearance::bench
