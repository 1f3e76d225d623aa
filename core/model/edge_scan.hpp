// The edge with the greatest directional derivative of those that leave a vertex.
#pragma once

#include <cstdint>

#include "core/convex_body.hpp"

namespace clearance {

struct SteepestEdge {
  double derivative = -kInfinity;  // along g, per unit length
  std::int32_t at = kNone;         // index into vertex_edges and neighbours
};

// The first of equals; g: in the body's frame. Sums in the order of vector registers' and a batch's
// lanes.
[[nodiscard]] inline SteepestEdge steepest_edge(const ConvexBody& body, const Vertex& vertex,
                                                const Vec3& g) noexcept {
  SteepestEdge best;
  for (std::int32_t i = 0; i < vertex.edges; ++i) {
    const Vec3 along = body.outgoing_of(vertex, i);
    const double derivative = (along.x() * g.x() + along.y() * g.y()) + along.z() * g.z();
    if (derivative > best.derivative) best = {derivative, vertex.first_edge + i};
  }
  return best;
}

}  // namespace clearance
