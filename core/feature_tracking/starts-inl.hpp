// Chooses the features at which tracking begins for two bodies without earlier features. Bodies are
// level if an axis of one is parallel to an axis of the other. Compiled once per vector width: see
// core/numerics/vec4-inl.hpp.
#if defined(CLEARANCE_CORE_STARTS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_STARTS
#undef CLEARANCE_CORE_STARTS
#else
#define CLEARANCE_CORE_STARTS
#endif

#include "core/feature_tracking/boxes-inl.hpp"
#include "core/feature_tracking/segments-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// Sets `side` to the vertex that the start table gives for `direction`, or to the only facet of a
// half-space, which has no vertices.
HWY_INLINE void start(const ConvexBody& body, Vec4 direction, Side& side) {
  if (body.vertices.empty()) {
    to_facet(side, 0);
  } else {
    to_vertex(side, body.start.at(vec3(direction)));
  }
}

// Returns the facet to the left of the i-th edge that leaves the vertex.
HWY_INLINE std::int32_t facet_around(const ConvexBody& body, const Vertex& vertex, std::int32_t i) {
  const EdgeUse& use = body.vertex_edges[vertex.first_edge + i];
  return body.edges[use.edge].facet[use.side];
}

// Sets `side` to the vertex's edge between the two facets. Without such an edge it stays as it is.
HWY_INLINE void to_edge_between(const ConvexBody& body, const Vertex& vertex, std::int32_t first,
                                std::int32_t second, Side& side) {
  for (std::int32_t i = 0; i < vertex.edges; ++i) {
    const std::int32_t edge = body.vertex_edges[vertex.first_edge + i].edge;
    const auto& beside = body.edges[edge].facet;
    if ((beside[0] == first && beside[1] == second) || (beside[0] == second && beside[1] == first))
      to_edge(side, edge);
  }
}

// Replaces two vertices by the parallel facets around them that face each other at a distance. If
// there are two pairs of such facets, the edges between them are closer than either pair.
HWY_INLINE void start_level(const Query4& q) {
  Side &on_a = q.state.a, &on_b = q.state.b;
  const Vertex& vertex_a = q.a.vertices[on_a.feature];
  const Vertex& vertex_b = q.b.vertices[on_b.feature];
  if (vertex_a.edges != 3 || vertex_b.edges != 3)
    return;  // other corners are rare among level bodies
  const Vec4 tip = point_to_a(q.a_from_b, load3_masked(vertex_b.position));
  std::int32_t facets_a[3], facets_b[3], pairs = 0;
  for (std::int32_t i = 0; i < 3; ++i) {
    const Facet& facet = q.a.facets[facet_around(q.a, vertex_a, i)];
    const Vec4 n = load3_padded(facet.normal);
    if (!(dot(n, tip) > facet.offset)) continue;
    const Vec4 n_in_b = direction_to_b(q.a_from_b, n);
    for (std::int32_t k = 0; k < 3; ++k) {
      const std::int32_t other = facet_around(q.b, vertex_b, k);
      const Vec4 tilt = n_in_b + load3_padded(q.b.facets[other].normal);
      if (!(dot(tilt, tilt) <= kParallelTilt * kParallelTilt)) continue;
      facets_a[pairs] = facet_around(q.a, vertex_a, i);
      facets_b[pairs++] = other;
      break;
    }
  }
  if (pairs == 1) {
    to_facet(on_a, facets_a[0]);
    to_facet(on_b, facets_b[0]);
  } else if (pairs == 2) {
    to_edge_between(q.a, vertex_a, facets_a[0], facets_a[1], on_a);
    to_edge_between(q.b, vertex_b, facets_b[0], facets_b[1], on_b);
  }
}

HWY_INLINE void start_at_vertices(const Query4& q) {
  const Vec4 a_to_b = point_to_a(q.a_from_b, load3(q.b.interior)) - load3(q.a.interior);
  start(q.a, a_to_b, q.state.a);
  start(q.b, -direction_to_b(q.a_from_b, a_to_b), q.state.b);
}

inline HWY_NOINLINE Start begin_level(const Query4& q) {
  const Start boxes = start_boxes(q);
  if (boxes != Start::kNone) return boxes;
  start_at_vertices(q);
  if (feature_pair(q.state) == FeaturePair::kVertexVertex) start_level(q);
  return Start::kDisjoint;
}

// Chooses features for a state that has none.
HWY_INLINE Start begin(const Query4& q) {
  if (!q.a.bounded() && !q.b.bounded()) return Start::kNone;  // they cannot be tracked
  if (are_segments(q.a, q.b)) {
    start_at_segments(q);
    return Start::kDisjoint;
  }
  if (HWY_UNLIKELY(shared_axes(squares_of(q.a_from_b.rotation)) != 0)) return begin_level(q);
  start_at_vertices(q);
  return Start::kDisjoint;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
