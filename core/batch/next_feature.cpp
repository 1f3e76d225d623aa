#include "core/batch/next_feature.hpp"

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

// Where an edge ends: it need not.
WalkStart go(Side& side, std::uint8_t dimension, std::int32_t feature) noexcept {
  if (feature == kNone) return {};
  side.dimension = dimension;
  side.feature = feature;
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
  return rate >= edge.end && far != kNone ? go(side, 0, far) : go(side, 1, use.edge);
}

WalkStart leave_edge(const ConvexPolyhedron& body, Side& side, std::int32_t next) noexcept {
  const Edge& edge = body.edges[side.feature];
  return next < kNextEnd ? go(side, 2, edge.facet[next - kNextBeside])
                         : go(side, 0, edge.vertex[next - kNextEnd]);
}

WalkStart from_edge_and_vertex(const Features& f, std::int32_t next) noexcept {
  if (next >= kNextBeside) return leave_edge(f.owner, f.on_owner, next);
  return go(f.on_other, 1, edge_of_vertex(f.other, f.on_other, next).edge);
}

WalkStart from_facet_and_vertex(const Features& f, std::int32_t next) noexcept {
  if (next >= kNextOfOther) {
    const EdgeUse& use = edge_of_vertex(f.other, f.on_other, next - kNextOfOther);
    return go(f.on_other, 0, f.other.edges[use.edge].vertex[1 - use.side]);
  }
  const Facet& facet = f.owner.facets[f.on_owner.feature];
  return go(f.on_owner, 1, f.owner.facet_edges[facet.first_side + next].edge);
}

// Of what rises beside crossing edges, or is level.
WalkStart to_facets_beside(const Features& f, std::int32_t next) noexcept {
  const std::int32_t of_a = next % kNextBesideB, of_b = next / kNextBesideB;
  const Edge& first = f.owner.edges[f.on_owner.feature];
  const Edge& second = f.other.edges[f.on_other.feature];
  if (of_a > 0) (void)go(f.on_owner, 2, first.facet[of_a - 1]);
  if (of_b > 0) (void)go(f.on_other, 2, second.facet[of_b - 1]);
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
