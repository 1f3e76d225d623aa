// A facet's vertices, counter-clockwise as seen from outside.
#pragma once

#include <vector>

#include "core/convex_polyhedron.hpp"

namespace clearance::bench {

[[nodiscard]] inline std::vector<int> corners(const ConvexPolyhedron& body, const Facet& facet) {
  std::vector<int> result;
  for (int i = facet.first_side; i < facet.first_side + facet.sides; ++i) {
    const EdgeUse& use = body.facet_edges[i];
    // A facet to the left of its edge passes it forwards, one to the right backwards.
    result.push_back(body.edges[use.edge].vertex[use.side == 0 ? 0 : 1]);
  }
  return result;
}

}  // namespace clearance::bench
