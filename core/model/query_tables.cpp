#include "core/model/query_tables.hpp"

#include <algorithm>

#include "core/numerics/error_constants.hpp"

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

void add_outgoing(ConvexPolyhedron& body) {
  body.outgoing.resize(body.vertex_edges.size());
  for (const Vertex& vertex : body.vertices) {
    for (std::int32_t i = 0; i < vertex.edges; ++i) {
      const EdgeUse& use = body.vertex_edges[vertex.first_edge + i];
      const Vec3& direction = body.edges[use.edge].direction;
      body.set_outgoing(vertex, i, use.side == 0 ? direction : Vec3(-direction));
    }
  }
}

// What lies on the far ends of vertices' edges, and on the far sides of facets'.
void add_neighbours(ConvexPolyhedron& body) {
  body.neighbours.clear();
  body.facets_beside.clear();
  for (const EdgeUse& use : body.vertex_edges) {
    body.neighbours.push_back(body.edges[use.edge].vertex[1 - use.side]);
  }
  for (const EdgeUse& use : body.facet_edges) {
    body.facets_beside.push_back(body.edges[use.edge].facet[1 - use.side]);
  }
}

// How far every facet is from the middle, less what can be off: a normal is by 2 roundings, their
// product by 3, the difference by 1, and whoever adds the radius to a product of their own adds 2.
double inner_radius(const ConvexPolyhedron& body) {
  constexpr double kRoundings = 16 * kUlp;
  if (!body.bounded() || body.facets.empty()) return 0.0;
  double nearest = kInfinity;
  for (const Facet& facet : body.facets) {
    nearest = std::min(nearest, facet.offset - facet.normal.dot(body.interior));
  }
  return std::max(0.0, nearest - kRoundings * body.bounding_radius - body.position_error);
}

void add_facet_limits(ConvexPolyhedron& body) {
  body.facet_limits.resize(body.facet_edges.size());
  for (const Facet& facet : body.facets) {
    for (std::int32_t i = 0; i < facet.limits; ++i) {
      const EdgeUse& use = body.facet_edges[facet.first_side + i];
      const Edge& edge = body.edges[use.edge];
      if (i < facet.sides) {
        const Vec3 inward = edge.inward.row(use.side);
        body.set_limit(facet, i, {inward, inward.dot(edge.point)});
      } else {
        const Vec3 back = use.side == 0 ? Vec3(-edge.direction) : edge.direction;
        body.set_limit(facet, i, {back, back.dot(body.anchors[edge.vertex[1 - use.side]])});
      }
    }
  }
}

void add_planes(ConvexPolyhedron& body) {
  const auto count = static_cast<std::int32_t>(body.facets.size());
  body.planes.resize(body.facets.size());
  for (std::int32_t i = 0; i < count; ++i) {
    for (std::int32_t k = 0; k < 3; ++k) {
      body.planes.set(0, count, i, k, body.facets[i].normal[k]);
    }
    body.planes.set(0, count, i, 3, body.facets[i].offset);
  }
}

// What grew while the body was made keeps no room to grow in.
void release_spare_room(ConvexPolyhedron& body) {
  body.facets.shrink_to_fit();
  body.edges.shrink_to_fit();
  body.vertices.shrink_to_fit();
  body.facet_edges.shrink_to_fit();
  body.vertex_edges.shrink_to_fit();
  body.anchors.shrink_to_fit();
  body.neighbours.shrink_to_fit();
  body.facets_beside.shrink_to_fit();
}

}  // namespace

void add_walking_tables(ConvexPolyhedron& body) {
  const double reach = body.bounded() ? body.bounding_radius : 0.0;
  body.slack_as_a = kUlp * kUlpsOnA * reach + (body.position_error + kUnderflow);
  body.slack_as_b = kUlp * kUlpsOnB * reach + body.position_error;
  body.inner_radius = inner_radius(body);
  add_opening(body);
  const auto count = [](const auto& all) { return static_cast<std::uint32_t>(all.size()); };
  body.features = {count(body.vertices), count(body.edges), count(body.facets)};
  add_outgoing(body);
  add_neighbours(body);
  add_facet_limits(body);
  add_planes(body);
  release_spare_room(body);
  if (body.vertices.empty()) return;
  std::int32_t at = 0;
  for (int cell = 0; cell < StartTable::kCells; ++cell) {
    at = farthest(body, StartTable::middle(cell), at);
    body.start.set(cell, at);
  }
}

}  // namespace clearance
