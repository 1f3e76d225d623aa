// A pair of features and its bodies, as the steps of core/feature_walk/steps-inl.hpp and
// core/feature_walk/parallel_steps-inl.hpp see them. Compiled once a vector width: see
// core/numerics/vec4-inl.hpp.
#if defined(CLEARANCE_CORE_WALKED_PAIR) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_WALKED_PAIR
#undef CLEARANCE_CORE_WALKED_PAIR
#else
#define CLEARANCE_CORE_WALKED_PAIR
#endif

#include <algorithm>

#include "core/distance_result.hpp"
#include "core/model/edge_scan.hpp"
#include "core/model/relative_pose-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// More than from two vertices to two facets.
inline constexpr int kLevelSteps = 6;

enum class Step { kHolds, kMoved, kLost };

using Side = TrackingState::Side;

// The pair, and what a step that holds finds: the closest points and the direction between them.
struct Walk {
  HWY_INLINE Walk(const ConvexPolyhedron& body_a, const ConvexPolyhedron& body_b,
                  const RelativeQuads& pose, TrackingState& state)
      : a(body_a), b(body_b), a_from_b(pose), on_a(state.a), on_b(state.b) {}

  const ConvexPolyhedron& a;
  const ConvexPolyhedron& b;
  const RelativeQuads& a_from_b;
  Side& on_a;
  Side& on_b;
  Quad point_a, point_b;  // frame A
  Quad own_b;             // point_b in frame B
  Quad normal;            // unit, from A to B, frame A
  double apart;           // m: |point_b - point_a|
  double proved;  // m: how far apart the direction proves the cores, before the slack of Precision
  double slack;   // m: of Precision
  int steps = 0;
  int levels = 0;  // of these, to features that are level

  // Of bodies that overlap (core/feature_walk/penetrating_steps-inl.hpp): `apart` is minus how
  // deep.
  bool overlapping = false;
  double room;    // m: of the edges' crossing, to their ends
  double beyond;  // m: the bodies may overlap by this less

  // Rounding may have them go in circles.
  [[nodiscard]] HWY_INLINE Step levelled() {
    return ++levels > kLevelSteps ? Step::kLost : Step::kMoved;
  }
};

// The features that a step goes on to. Poses that are none lead beyond the ends of edges that have
// none: to no feature.
HWY_INLINE Step to_vertex(Side& side, std::int32_t vertex) {
  side.dimension = vertex == kNone ? TrackingState::kCold : 0;
  side.feature = vertex;
  return Step::kMoved;
}
HWY_INLINE Step to_edge(Side& side, std::int32_t edge) {
  side.dimension = 1;
  side.feature = edge;
  return Step::kMoved;
}
HWY_INLINE Step to_facet(Side& side, std::int32_t facet) {
  side.dimension = 2;
  side.feature = facet;
  return Step::kMoved;
}

// The first lanes of four, at most.
HWY_INLINE unsigned first_lanes(std::int32_t count) { return count < 4 ? 15u >> (4 - count) : 15u; }

// How fast up to four of a row's n vectors, from number i on, rise along g.
HWY_INLINE Quad rates(const double* row, std::int32_t n, std::int32_t i, const Quad (&g)[3]) {
  return (load4(row + i) * g[0] + load4(row + n + i) * g[1]) + load4(row + 2 * n + i) * g[2];
}

// Does a vertex's every edge fall away along g, by more than -limit per unit length?
HWY_INLINE bool all_fall(const ConvexPolyhedron& body, const Vertex& vertex, Quad g, double limit) {
  const double* row = body.outgoing.row(vertex.first_edge);
  const std::int32_t n = vertex.edges;
  const Quad along[3] = {spread(lane(g, 0)), spread(lane(g, 1)), spread(lane(g, 2))};
  unsigned rise = ~less(rates(row, n, 0, along), spread(limit)) & first_lanes(n);
  for (std::int32_t i = 4; HWY_UNLIKELY(i < n); i += 4) {
    rise |= ~less(rates(row, n, i, along), spread(limit)) & first_lanes(n - i);
  }
  return rise == 0;
}

// In the order of the sums of Quads, and of a batch's lanes.
HWY_INLINE double dot(const Vec3& u, const Vec3& v) {
  return (u.x() * v.x() + u.y() * v.y()) + u.z() * v.z();
}

inline HWY_NOINLINE SteepestEdge steepest(const ConvexPolyhedron& body, const Vertex& vertex,
                                          const Vec3& g) {
  const std::int32_t n = vertex.edges;
  if (HWY_UNLIKELY(n > 4)) return steepest_edge(body, vertex, g);
  SteepestEdge best;
  const auto take = [&](double rate, std::int32_t i) HWY_ATTR {
    if (rate > best.rate) best = {rate, vertex.first_edge + i};
  };
  const Quad along[3] = {spread(g.x()), spread(g.y()), spread(g.z())};
  const Quad rise = rates(body.outgoing.row(vertex.first_edge), n, 0, along);
  if (n > 0) take(lane(rise, 0), 0);
  if (n > 1) take(lane(rise, 1), 1);
  if (n > 2) take(lane(rise, 2), 2);
  if (n > 3) take(lane(rise, 3), 3);
  return best;
}
HWY_INLINE SteepestEdge steepest(const ConvexPolyhedron& body, const Vertex& vertex, Quad g) {
  return steepest(body, vertex, vec3(g));
}

// How fast the facets beside an edge, left and right, rise along g; a segment's only edge has none.
HWY_INLINE Pair side_rates(const Edge& edge, Quad g) {
  const double* inward = edge.inward.data();
  return (load2(inward) * pair(lane(g, 0)) + load2(inward + 2) * pair(lane(g, 1))) +
         load2(inward + 4) * pair(lane(g, 2));
}

// Do both fall away along g, by more than -limit per unit length?
HWY_INLINE bool sides_fall(const Edge& edge, Quad g, double limit) {
  return edge.facet[0] == kNone || both_less(side_rates(edge, g), pair(limit));
}

// 1/|v| and 1/|v|^2 of what is a unit vector up to some roundings.
HWY_INLINE double over_norm(Quad v) { return 1.5 - 0.5 * dot(v, v); }
HWY_INLINE double over_square(Quad v) { return 2.0 - dot(v, v); }

// One of the bodies, the owner of an edge or facet, and the other with its vertex. kMoved: the
// owner is B.
template <bool kMoved>
struct Owned {
  Walk& w;
  [[nodiscard]] HWY_INLINE const ConvexPolyhedron& owner() const { return kMoved ? w.b : w.a; }
  [[nodiscard]] HWY_INLINE const ConvexPolyhedron& other() const { return kMoved ? w.a : w.b; }
  [[nodiscard]] HWY_INLINE Side& on_owner() const { return kMoved ? w.on_b : w.on_a; }
  [[nodiscard]] HWY_INLINE Side& on_other() const { return kMoved ? w.on_a : w.on_b; }
  [[nodiscard]] HWY_INLINE Quad point_in(Quad p) const {
    return kMoved ? point_to_b(w.a_from_b, p) : point_to_a(w.a_from_b, p);
  }
  [[nodiscard]] HWY_INLINE Quad point_out(Quad p) const { return opposite().point_in(p); }
  [[nodiscard]] HWY_INLINE Quad direction_in(Quad v) const { return opposite().direction_out(v); }
  [[nodiscard]] HWY_INLINE Quad direction_out(Quad v) const {
    return kMoved ? direction_to_a(w.a_from_b, v) : direction_to_b(w.a_from_b, v);
  }
  [[nodiscard]] HWY_INLINE Owned<!kMoved> opposite() const { return {w}; }
  // The owner's in frame A, and what is in frame A in the owner's.
  [[nodiscard]] HWY_INLINE Quad point_to_common(Quad p) const {
    return kMoved ? point_to_a(w.a_from_b, p) : p;
  }
  [[nodiscard]] HWY_INLINE Quad direction_to_common(Quad v) const {
    return kMoved ? direction_to_a(w.a_from_b, v) : v;
  }
  [[nodiscard]] HWY_INLINE Quad direction_to_own(Quad v) const {
    return kMoved ? direction_to_b(w.a_from_b, v) : v;
  }
  // How far a point of the other, by itself and in the owner's frame, lies outside the owner's
  // facet; n: the facet's normal, direction_to_common().
  [[nodiscard]] HWY_INLINE double height(const Facet& facet, Quad others, Quad own, Quad n) const {
    if (!kMoved) return dot(n, own) - facet.offset;
    return over_norm(n) * dot(n, others - w.a_from_b.translation) - facet.offset;
  }
  // Witness points: on the owner in its own frame and in A's, and so of the other.
  HWY_INLINE void place(Quad own, Quad common, Quad others_own, Quad others_common) const {
    w.point_a = kMoved ? others_common : common;
    w.own_b = kMoved ? own : others_own;
    w.point_b = kMoved ? common : others_common;
  }
  // The same for such a point, `apart` outside the facet, and the facet; and the normal.
  HWY_INLINE void place_above(const Facet& facet, double apart, Quad others, Quad own,
                              Quad n) const {
    const Quad own_n = load3_of_4(facet.normal);
    if (kMoved) {
      const Quad below = own - (dot(own_n, own) - facet.offset) * own_n;
      place(below, point_to_a(w.a_from_b, below), others, others);
      w.normal = -over_norm(n) * n;
    } else {
      place(own - apart * n, own - apart * n, others, own);
      w.normal = n;
    }
  }
};

// What limits the facet's polygon, as an edge, beyond which the tip lies farthest; kNone: it lies
// within.
HWY_INLINE std::int32_t side_beyond(const ConvexPolyhedron& body, const Facet& facet, Quad tip) {
  const double* row = body.facet_limits.row(facet.first_side);
  const std::int32_t n = facet.limits;
  const Quad at[3] = {spread(lane(tip, 0)), spread(lane(tip, 1)), spread(lane(tip, 2))};
  double least = 0.0;
  std::int32_t beyond = kNone;
  for (std::int32_t i = 0; i < n; i += 4) {
    const Quad within = rates(row, n, i, at) - load4(row + 3 * n + i);
    if (HWY_LIKELY((less(within, spread(least)) & first_lanes(n - i)) == 0)) continue;
    for (std::int32_t k = 0; k < 4 && i + k < n; ++k) {
      if (!(lane(within, k) < least)) continue;
      least = lane(within, k);
      beyond = body.facet_edges[facet.first_side + i + k].edge;
    }
  }
  return beyond;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
