#include "core/model/footprint.hpp"

namespace clearance {
namespace {

template <class... T>
std::size_t bytes_of(const std::vector<T>&... tables) noexcept {
  return (... + (tables.size() * sizeof(T)));
}

}  // namespace

std::size_t footprint(const ConvexPolyhedron& body) noexcept {
  const Opening& opening = body.opening;
  return sizeof body +
         bytes_of(body.facets, body.edges, body.vertices, body.facet_edges, body.vertex_edges,
                  body.anchors, body.rays, opening.rays, body.neighbours, body.facets_beside) +
         body.outgoing.bytes() + body.facet_limits.bytes() + body.planes.bytes();
}

}  // namespace clearance
