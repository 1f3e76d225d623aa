#include "core/walking_tables.hpp"

#include <limits>

namespace clearance {
namespace {

// The vertex that is farthest along d, climbing from another.
std::int32_t farthest(const ConvexPolyhedron& body, const Vec3& d, std::int32_t at) {
  for (bool higher = true; higher;) {
    higher = false;
    const Vertex vertex = body.vertices[at];
    for (std::int32_t i = 0; i < vertex.edges; ++i) {
      const EdgeUse& use = body.vertex_edges[vertex.first_edge + i];
      const std::int32_t to = body.edges[use.edge].vertex[1 - use.side];
      if (to != kNone && d.dot(body.vertices[to].position) > d.dot(body.vertices[at].position)) {
        at = to;
        higher = true;
      }
    }
  }
  return at;
}

}  // namespace

void add_walking_tables(ConvexPolyhedron& body) {
  body.outgoing.clear();
  for (const EdgeUse& use : body.vertex_edges) {
    const Vec3& direction = body.edges[use.edge].direction;
    body.outgoing.push_back(use.side == 0 ? direction : Vec3(-direction));
  }
  body.facet_sides.clear();
  for (const EdgeUse& use : body.facet_edges) {
    const Edge& edge = body.edges[use.edge];
    const Vec3& inward = edge.inward[use.side];
    body.facet_sides.push_back({inward, inward.dot(edge.point)});
  }
  if (body.vertices.empty() || body.vertices.size() > std::numeric_limits<std::uint16_t>::max()) {
    return;
  }
  std::int32_t at = 0;
  for (int cell = 0; cell < StartTable::kCells; ++cell) {
    at = farthest(body, StartTable::middle(cell), at);
    body.start.set(cell, at);
  }
}

}  // namespace clearance
