#include "core/lambda.hpp"

namespace clearance {
namespace {

Lambda of_facet(const ActiveSide& side, const Vec3& towards) noexcept {
  return {-side.facet().normal.dot(towards), Feature::kInside, kNone};
}

Lambda of_edge(const ActiveSide& side, const Vec3& towards) noexcept {
  const Edge& edge = side.edge();
  Lambda best;
  for (int k = 0; k < 2; ++k) {
    const double rate = edge.inward[k].dot(towards);
    if (rate > best.rate) best = {rate, Feature::kFacet, edge.facet[k]};
  }
  return best;
}

Lambda of_vertex(const ActiveSide& side, const Vec3& towards) noexcept {
  const Vertex& vertex = side.vertex();
  Lambda best;
  for (std::int32_t i = 0; i < vertex.edges; ++i) {
    const EdgeUse& use = side.body().vertex_edges[vertex.first_edge + i];
    const double along = side.body().edges[use.edge].direction.dot(towards);
    const double rate = use.side == 0 ? along : -along;
    if (rate > best.rate) best = {rate, Feature::kEdge, use.edge};
  }
  return best;
}

}  // namespace

Lambda lambda(const ActiveSide& side, const Vec3& towards_in_common) noexcept {
  if (side.feature() == Feature::kInside) return {};
  const Vec3 towards = side.direction_to_own(towards_in_common);
  if (side.feature() == Feature::kFacet) return of_facet(side, towards);
  return side.feature() == Feature::kEdge ? of_edge(side, towards) : of_vertex(side, towards);
}

}  // namespace clearance
