// Among the edges that leave a vertex, finds the one with the greatest directional derivative.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/convex_body.hpp"

namespace clearance {

struct SteepestEdge {
  double derivative = -kInfinity;  // along g, per unit length
  std::int32_t at = kNone;         // index into vertex_edges and neighbours
};

// If several are equal, the first one. g: in the body's frame. Sums have the same order as in
// vector registers and in a batch's lanes. No branch depends on a derivative.
[[nodiscard]] inline SteepestEdge steepest_edge(const ConvexBody& body, const Vertex& vertex,
                                                const Vec3& g) noexcept {
  SteepestEdge best;
  for (std::int32_t i = 0; i < vertex.edges; ++i) {
    const Vec3 along = body.outgoing_of(vertex, i);
    const double derivative = (along.x() * g.x() + along.y() * g.y()) + along.z() * g.z();
    const bool steeper = derivative > best.derivative;
    best.derivative = std::max(best.derivative, derivative);
    best.at ^= (best.at ^ (vertex.first_edge + i)) & -static_cast<std::int32_t>(steeper);
  }
  return best;
}

}  // namespace clearance
