// The directional derivatives of the neighbours of a vertex or an edge, and the limits of a facet,
// four at a time. Compiled once per vector width: see core/numerics/vec4-inl.hpp.
//
// A vertex is the support point of a convex body along g if all its edges recede: every directional
// derivative along g is negative. An edge orthogonal to g is the support set if both of its facets
// recede. These are the tests that certify a pair.
#if defined(CLEARANCE_CORE_EDGE_SCAN) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_EDGE_SCAN
#undef CLEARANCE_CORE_EDGE_SCAN
#else
#define CLEARANCE_CORE_EDGE_SCAN
#endif

#include <algorithm>

#include "core/model/edge_scan.hpp"
#include "core/numerics/vec4-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// A direction or a point, as products with the vectors of a row need it.
struct Spread3 {
  HWY_INLINE explicit Spread3(Vec4 v)
      : x(spread(lane(v, 0))), y(spread(lane(v, 1))), z(spread(lane(v, 2))) {}
  Vec4 x, y, z;
};
// The directional derivatives along g of the four vectors that begin at `four` of a row.
HWY_INLINE Vec4 derivatives(const double* four, const Spread3& g) {
  return (load4(four) * g.x + load4(four + 4) * g.y) + load4(four + 8) * g.z;
}
// Returns how far a point is within the four limits from `four` of a facet's row, m.
HWY_INLINE Vec4 inside_limits(const double* four, const Spread3& at) {
  return derivatives(four, at) - load4(four + 12);
}
inline constexpr std::ptrdiff_t kFourDirections = 12, kFourLimits = 16;  // numbers

// Is the directional derivative along g of every edge of a vertex below `limit`, per unit length?
// A point has no edges; its row is NaN.
HWY_INLINE bool all_edges_recede(const ConvexBody& body, const Vertex& vertex, Vec4 g,
                                 double limit) {
  const double* four = body.outgoing.row(vertex.first_edge);
  const Spread3 along(g);
  unsigned others = at_least(derivatives(four, along), spread(limit));
  for (std::int32_t i = 4; HWY_UNLIKELY(i < vertex.edges); i += 4) {
    four += kFourDirections;
    others |= at_least(derivatives(four, along), spread(limit));
  }
  return others == 0;
}

// In the order of the sums of Vec4, and of a batch's lanes.
HWY_INLINE double dot(const Vec3& u, const Vec3& v) {
  return (u.x() * v.x() + u.y() * v.y()) + u.z() * v.z();
}

// Finds the same edge as steepest_edge(). It has no branch per edge, since no processor could
// predict the outcome.
inline HWY_NOINLINE SteepestEdge steepest(const ConvexBody& body, const Vertex& vertex,
                                          const Vec3& g) {
  SteepestEdge none;
  Vec4 best = spread(none.derivative), at = spread(0.0);
  const double* four = body.outgoing.row(vertex.first_edge);
  const Spread3 along(vec4(g.x(), g.y(), g.z(), 0.0));
  Vec4 numbers = vec4(0.0, 1.0, 2.0, 3.0);
  for (std::int32_t i = 0; i < vertex.edges; i += 4, four += kFourDirections) {
    const Vec4 derivative = derivatives(four, along);
    at = where_less(best, derivative, numbers, at);
    best = where_less(best, derivative, derivative, best);
    numbers = numbers + spread(4.0);
  }
  const double greatest =
      std::max(std::max(lane(best, 0), lane(best, 1)), std::max(lane(best, 2), lane(best, 3)));
  if (!(greatest > none.derivative)) return none;
  at = where_less(best, spread(greatest), spread(kInfinity), at);
  const double first =
      std::min(std::min(lane(at, 0), lane(at, 1)), std::min(lane(at, 2), lane(at, 3)));
  return {greatest, vertex.first_edge + static_cast<std::int32_t>(first)};
}
HWY_INLINE SteepestEdge steepest(const ConvexBody& body, const Vertex& vertex, Vec4 g) {
  return steepest(body, vertex, vec3(g));
}

// The directional derivatives along g of the facets beside an edge, left and right; a segment's
// only edge has none.
HWY_INLINE Vec2 facet_derivatives(const Edge& edge, Vec4 g) {
  const double* inward = edge.inward.data();
  return (load2(inward) * vec2(lane(g, 0)) + load2(inward + 2) * vec2(lane(g, 1))) +
         load2(inward + 4) * vec2(lane(g, 2));
}

// Are both below `limit`, per unit length?
HWY_INLINE bool both_facets_recede(const Edge& edge, Vec4 g, double limit) {
  return edge.facet[0] == kNone || both_less(facet_derivatives(edge, g), vec2(limit));
}

// The edge of the limit of the facet's polygon that the tip violates most; kNone: the tip lies
// within.
HWY_INLINE std::int32_t crossed_side(const ConvexBody& body, const Facet& facet, Vec4 tip) {
  const double* four = body.facet_limits.row(facet.first_side);
  const Spread3 at(tip);
  double least = 0.0;
  std::int32_t crossed = kNone;
  for (std::int32_t i = 0; i < facet.limits; i += 4, four += kFourLimits) {
    const Vec4 inside = inside_limits(four, at);
    if (HWY_LIKELY(less(inside, spread(least)) == 0)) continue;
    for (std::int32_t k = 0; k < 4; ++k) {
      if (!(lane(inside, k) < least)) continue;
      least = lane(inside, k);
      crossed = body.facet_edges[facet.first_side + i + k].edge;
    }
  }
  return crossed;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
