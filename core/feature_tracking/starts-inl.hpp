// Chooses the features at which tracking begins for two bodies without earlier features. Bodies are
// level if an axis of one is parallel to an axis of the other. Compiled once a vector width: see
// core/numerics/vec4-inl.hpp.
#if defined(CLEARANCE_CORE_STARTS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_STARTS
#undef CLEARANCE_CORE_STARTS
#else
#define CLEARANCE_CORE_STARTS
#endif

#include "core/feature_tracking/pair-inl.hpp"
#include "core/numerics/error_constants.hpp"

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
HWY_INLINE void start_level(TrackedPair& pair) {
  const Vertex& of_a = pair.a.vertices[pair.on_a.feature];
  const Vertex& of_b = pair.b.vertices[pair.on_b.feature];
  if (of_a.edges != 3 || of_b.edges != 3) return;  // other corners are rare among level bodies
  const Vec4 tip = point_to_a(pair.a_from_b, load3_alone(of_b.position));
  std::int32_t facets_a[3], facets_b[3], pairs = 0;
  for (std::int32_t i = 0; i < 3; ++i) {
    const Facet& facet = pair.a.facets[facet_around(pair.a, of_a, i)];
    const Vec4 n = load3_of_4(facet.normal);
    if (!(dot(n, tip) > facet.offset)) continue;
    const Vec4 n_in_b = direction_to_b(pair.a_from_b, n);
    for (std::int32_t k = 0; k < 3; ++k) {
      const std::int32_t other = facet_around(pair.b, of_b, k);
      const Vec4 tilt = n_in_b + load3_of_4(pair.b.facets[other].normal);
      if (!(dot(tilt, tilt) <= kParallelTilt * kParallelTilt)) continue;
      facets_a[pairs] = facet_around(pair.a, of_a, i);
      facets_b[pairs++] = other;
      break;
    }
  }
  if (pairs == 1) {
    to_facet(pair.on_a, facets_a[0]);
    to_facet(pair.on_b, facets_b[0]);
  } else if (pairs == 2) {
    to_edge_between(pair.a, of_a, facets_a[0], facets_a[1], pair.on_a);
    to_edge_between(pair.b, of_b, facets_b[0], facets_b[1], pair.on_b);
  }
}

// Returns a bit mask of the axes of A's frame that are parallel to one of B's within rounding.
// `squares` has the squared elements of the rotation matrix.
HWY_INLINE unsigned shared_axes(const Diagonals& squares) {
  const Vec4 limit = spread(1.0 - 0x1p-46);
  return (less(limit, squares.main) | less(limit, squares.next) | less(limit, squares.last)) & 7u;
}
HWY_INLINE Diagonals squares_of(const Diagonals& m) {
  return {m.main * m.main, m.next * m.next, m.last * m.last};
}

inline constexpr FeatureKind kKindByAxes[8] = {
    FeatureKind::kUnknown, FeatureKind::kFacet, FeatureKind::kFacet, FeatureKind::kEdge,
    FeatureKind::kFacet,   FeatureKind::kEdge,  FeatureKind::kEdge,  FeatureKind::kVertex};

HWY_INLINE void to_farthest(const BoxFeatures& box, unsigned axes, unsigned negative, Side& side) {
  side.kind = kKindByAxes[axes];
  side.feature = box.farthest[axes | (negative & 7u) << 3];
}

// The axis of the greatest of three numbers, as a bit.
HWY_INLINE unsigned greatest_axis(Vec4 v) {
  const double x = lane(v, 0), y = lane(v, 1), z = lane(v, 2);
  return x >= y && x >= z ? 1u : y >= z ? 2u : 4u;
}

// If the gaps between two boxes lie along shared axes only, chooses the features that face each
// other. If the boxes overlap along all axes, chooses the facets across the axis of the least
// overlap. Otherwise returns false.
HWY_INLINE bool start_boxes(TrackedPair& pair) {
  const BoxFeatures &a = pair.a.box, &b = pair.b.box;
  if (!a.exist() || !b.exist()) return false;
  const Diagonals squares = squares_of(pair.a_from_b.rotation);
  const unsigned shared = shared_axes(squares);
  const Vec4 between = point_to_a(pair.a_from_b, load3_of_4(b.centre)) - load3_of_4(a.centre);
  const Vec4 zero = spread(0.0), up = where_less(between, zero, spread(-1.0), spread(1.0));
  const Vec4 gaps = up * between - (load3_of_4(a.half) + squares * load3_of_4(b.half));
  unsigned axes = less(zero, gaps) & 7u;
  if (axes == 0) axes = greatest_axis(gaps);
  if ((axes & ~shared) != 0 || (shared != 7u && axes != shared)) return false;
  // The same axes in B's frame. B's features face the other way.
  const auto chosen = [axes](unsigned axis) { return (axes & axis) != 0 ? 1.0 : 0.0; };
  const Vec4 in_b = direction_to_b(pair.a_from_b, vec4(chosen(1), chosen(2), chosen(4), 0.0) * up);
  const double size = pair.a.bounding_radius + pair.b.bounding_radius;
  pair.starts_in_contact = (less(gaps, spread(kMayTouch * size)) & 7u) == 7u;
  to_farthest(a, axes, less(between, zero), pair.on_a);
  to_farthest(b, less(spread(0.25), in_b * in_b) & 7u, less(zero, in_b), pair.on_b);
  // The witness points of whole facets and edges will be halfway between these.
  pair.on_a.point = a.centre;
  pair.on_b.point = b.centre;
  return true;
}

HWY_INLINE void start_at_vertices(TrackedPair& pair) {
  const Vec4 a_to_b = point_to_a(pair.a_from_b, load3(pair.b.interior)) - load3(pair.a.interior);
  start(pair.a, a_to_b, pair.on_a);
  start(pair.b, -direction_to_b(pair.a_from_b, a_to_b), pair.on_b);
}

inline HWY_NOINLINE void begin_level(TrackedPair& pair) {
  if (start_boxes(pair)) return;
  start_at_vertices(pair);
  if (pair.features() == FeaturePair::kVertexVertex) start_level(pair);
}

// Chooses features if the state has none.
HWY_INLINE void begin(TrackedPair& pair) {
  if (exists(pair.a, pair.on_a) && exists(pair.b, pair.on_b)) return;
  if (HWY_UNLIKELY(shared_axes(squares_of(pair.a_from_b.rotation)) != 0)) return begin_level(pair);
  start_at_vertices(pair);
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
