#include "core/batch/next_feature.hpp"

namespace clearance {
namespace {

using Side = TrackingState::Side;

// The features on either side: the owner is the one with the edge or facet.
struct Features {
  const ConvexBody& owner;
  const ConvexBody& other;
  Side& on_owner;
  Side& on_other;
};

constexpr TransitionsMade kOneTransition{.transitions = 1};

// `feature` is kNone at the open end of an edge: no transition.
TransitionsMade go(Side& side, FeatureKind kind, std::int32_t feature) noexcept {
  if (feature == kNone) return {};
  side.kind = kind;
  side.feature = feature;
  return kOneTransition;
}

const EdgeUse& edge_of_vertex(const ConvexBody& body, const Side& side, std::int32_t i) noexcept {
  return body.vertex_edges[body.vertices[side.feature].first_edge + i];
}

// Moves onto the vertex's edge, or past it to its far end.
TransitionsMade along_edge(const ConvexBody& body, Side& side, std::int32_t i,
                           double derivative) noexcept {
  const EdgeUse& use = edge_of_vertex(body, side, i);
  const Edge& edge = body.edges[use.edge];
  // `derivative` is g.e with |g| the distance and |e| = 1: the place of the closest point along the
  // edge's line, m.
  const std::int32_t far = edge.vertex[1 - use.side];
  return derivative >= edge.end && far != kNone ? go(side, FeatureKind::kVertex, far)
                                                : go(side, FeatureKind::kEdge, use.edge);
}

// Moves to the facet beside the edge that approaches, or to the end that the closest point has
// passed.
TransitionsMade leave_edge(const ConvexBody& body, Side& side, std::int32_t next) noexcept {
  const Edge& edge = body.edges[side.feature];
  return next < kNextEnd ? go(side, FeatureKind::kFacet, edge.facet[next - kNextBeside])
                         : go(side, FeatureKind::kVertex, edge.vertex[next - kNextEnd]);
}

TransitionsMade from_edge_and_vertex(const Features& f, std::int32_t next) noexcept {
  if (next >= kNextBeside) return leave_edge(f.owner, f.on_owner, next);
  return go(f.on_other, FeatureKind::kEdge, edge_of_vertex(f.other, f.on_other, next).edge);
}

// If an edge of the vertex approaches, the vertex at its far end is next, or the edge itself if its
// end is below the plane. If the vertex is past a side of the facet, the edge at that side is next.
TransitionsMade from_facet_and_vertex(const Features& f, std::int32_t next,
                                      double to_plane) noexcept {
  if (next >= kNextOfOther) {
    const EdgeUse& use = edge_of_vertex(f.other, f.on_other, next - kNextOfOther);
    const Edge& edge = f.other.edges[use.edge];
    const std::int32_t far = edge.vertex[1 - use.side];
    return to_plane > edge.end || far == kNone ? go(f.on_other, FeatureKind::kVertex, far)
                                               : go(f.on_other, FeatureKind::kEdge, use.edge);
  }
  const Facet& facet = f.owner.facets[f.on_owner.feature];
  return go(f.on_owner, FeatureKind::kEdge, f.owner.facet_edges[facet.first_side + next].edge);
}

// Moves to the facets beside crossing edges that do not recede.
TransitionsMade to_facets_beside(const Features& f, std::int32_t next) noexcept {
  const std::int32_t of_a = next % kNextBesideB, of_b = next / kNextBesideB;
  const Edge& first = f.owner.edges[f.on_owner.feature];
  const Edge& second = f.other.edges[f.on_other.feature];
  if (of_a > 0) (void)go(f.on_owner, FeatureKind::kFacet, first.facet[of_a - 1]);
  if (of_b > 0) (void)go(f.on_other, FeatureKind::kFacet, second.facet[of_b - 1]);
  return {.transitions = 1, .parallel_transitions = 1};
}

// The ends come first (unless_past_end() of neighbours-inl.hpp), then the facets beside.
TransitionsMade from_edges(const Features& f, std::int32_t next) noexcept {
  if (next < kNextEnd) return to_facets_beside(f, next);
  if (next < kNextEndB) return leave_edge(f.owner, f.on_owner, next);
  return leave_edge(f.other, f.on_other, next - kNextEndB + kNextEnd);
}

}  // namespace

TransitionsMade to_next_feature(FeaturePair features, const ConvexBody& a, const ConvexBody& b,
                                const FailedLanes& of, std::size_t lane,
                                TrackingState& state) noexcept {
  const auto next = static_cast<std::int32_t>(of.next[lane]);
  if (next == kNextUnknown) return {};
  const Features f = kind_on_b(features) > kind_on_a(features) ? Features{b, a, state.b, state.a}
                                                               : Features{a, b, state.a, state.b};
  switch (features) {
    case FeaturePair::kVertexVertex:
      if (next < kNextOfOther) return along_edge(a, state.a, next, of.derivative[lane]);
      return along_edge(b, state.b, next - kNextOfOther, of.derivative[lane]);
    case FeaturePair::kVertexEdge:
    case FeaturePair::kEdgeVertex:
      return from_edge_and_vertex(f, next);
    case FeaturePair::kVertexFacet:
    case FeaturePair::kFacetVertex:
      return from_facet_and_vertex(f, next, of.derivative[lane]);
    case FeaturePair::kEdgeEdge:
      return from_edges(f, next);
    default:
      break;
  }
  return {};
}

}  // namespace clearance
