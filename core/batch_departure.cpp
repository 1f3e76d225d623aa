#include "core/batch_departure.hpp"

namespace clearance {
namespace {

using Side = TrackingState::Side;

// The features on either side: the owner is the one with the edge or facet.
struct Features {
  const ConvexPolyhedron& owner;
  const ConvexPolyhedron& other;
  Side& on_owner;
  Side& on_other;
};

constexpr WalkStart kOneStep{.steps = 1};

WalkStart to_edge(Side& side, std::int32_t edge) noexcept {
  side.dimension = 1;
  side.feature = edge;
  return kOneStep;
}

// Where an edge ends: it need not.
WalkStart to_vertex(Side& side, std::int32_t vertex) noexcept {
  if (vertex == kNone) return {};
  side.dimension = 0;
  side.feature = vertex;
  return kOneStep;
}

WalkStart to_facet(Side& side, std::int32_t facet) noexcept {
  side.dimension = 2;
  side.feature = facet;
  return kOneStep;
}

const EdgeUse& edge_of_vertex(const ConvexPolyhedron& body, const Side& side,
                              std::int32_t i) noexcept {
  return body.vertex_edges[body.vertices[side.feature].first_edge + i];
}

// Onto the vertex's edge, or past it to its far end.
WalkStart along_edge(const ConvexPolyhedron& body, Side& side, std::int32_t i,
                     double rate) noexcept {
  const EdgeUse& use = edge_of_vertex(body, side, i);
  const Edge& edge = body.edges[use.edge];
  const std::int32_t far = edge.vertex[1 - use.side];
  return rate >= edge.end && far != kNone ? to_vertex(side, far) : to_edge(side, use.edge);
}

WalkStart leave_edge(const ConvexPolyhedron& body, Side& side, std::int32_t next) noexcept {
  const Edge& edge = body.edges[side.feature];
  return next < kNextEnd ? to_facet(side, edge.facet[next - kNextBeside])
                         : to_vertex(side, edge.vertex[next - kNextEnd]);
}

WalkStart from_edge_and_vertex(const Features& f, std::int32_t next) noexcept {
  if (next >= kNextBeside) return leave_edge(f.owner, f.on_owner, next);
  return to_edge(f.on_other, edge_of_vertex(f.other, f.on_other, next).edge);
}

WalkStart from_facet_and_vertex(const Features& f, std::int32_t next) noexcept {
  if (next >= kNextOfOther) {
    const EdgeUse& use = edge_of_vertex(f.other, f.on_other, next - kNextOfOther);
    return to_vertex(f.on_other, f.other.edges[use.edge].vertex[1 - use.side]);
  }
  const Facet& facet = f.owner.facets[f.on_owner.feature];
  return to_edge(f.on_owner, f.owner.facet_edges[facet.first_side + next].edge);
}

// Of what rises beside crossing edges, or is level.
WalkStart to_facets_beside(const Features& f, std::int32_t next) noexcept {
  const std::int32_t of_a = next % kNextBesideB, of_b = next / kNextBesideB;
  const Edge& first = f.owner.edges[f.on_owner.feature];
  const Edge& second = f.other.edges[f.on_other.feature];
  if (of_a > 0) to_facet(f.on_owner, first.facet[of_a - 1]);
  if (of_b > 0) to_facet(f.on_other, second.facet[of_b - 1]);
  return {.steps = 1, .levels = 1};
}

WalkStart from_edges(const Features& f, std::int32_t next) noexcept {
  if (next < kNextEnd) return to_facets_beside(f, next);
  if (next < kNextEndB) return leave_edge(f.owner, f.on_owner, next);
  return leave_edge(f.other, f.on_other, next - kNextEndB + kNextEnd);
}

}  // namespace

WalkStart depart(FeatureKind kind, const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                 const FailedLanes& of, std::size_t lane, TrackingState& state) noexcept {
  const auto next = static_cast<std::int32_t>(of.next[lane]);
  if (next == kNextUnknown) return {};
  const Features from_a{a, b, state.a, state.b}, from_b{b, a, state.b, state.a};
  switch (kind) {
    case FeatureKind::kVertexVertex:
      if (next < kNextOfOther) return along_edge(a, state.a, next, of.rate[lane]);
      return along_edge(b, state.b, next - kNextOfOther, of.rate[lane]);
    case FeatureKind::kVertexEdge:
      return from_edge_and_vertex(from_b, next);
    case FeatureKind::kEdgeVertex:
      return from_edge_and_vertex(from_a, next);
    case FeatureKind::kVertexFacet:
      return from_facet_and_vertex(from_b, next);
    case FeatureKind::kFacetVertex:
      return from_facet_and_vertex(from_a, next);
    case FeatureKind::kEdgeEdge:
      return from_edges(from_a, next);
    case FeatureKind::kEdgeFacet:
    case FeatureKind::kFacetEdge:
    case FeatureKind::kFacetFacet:
      break;
  }
  return {};
}

}  // namespace clearance
