// Steps of the walk for features that are level: whole edges or facets are closest, as far as
// rounding can tell. Compiled once a vector width: see core/numerics/vec4-inl.hpp.
//
// Any pair of points that face each other would do. Halfway between the last witness points of
// both bodies is as steady as the bodies' motion, and mostly within both features; where it is not,
// the nearest point along the side that it has passed. The direction between the features proves
// less by what it is tilted against them.
#if defined(CLEARANCE_CORE_LEVEL_WALK) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_LEVEL_WALK
#undef CLEARANCE_CORE_LEVEL_WALK
#else
#define CLEARANCE_CORE_LEVEL_WALK
#endif

#include <algorithm>
#include <cmath>

#include "core/feature_walk/pair-inl.hpp"
#include "core/numerics/error_constants.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// How much less the direction proves, if by `tilt` it is not at right angles to a feature: either
// body's extent along it may be another over its whole size, and it is enough that one's is.
HWY_INLINE double lost_by_tilt(const Walk& w, double tilt) {
  const double a = w.a.bounded() ? w.a.bounding_radius : kInfinity;
  const double b = w.b.bounded() ? w.b.bounding_radius : kInfinity;
  return 2.0 * std::min(a, b) * (tilt + kTiltError);
}

// From an edge to the facet beside it that rises along g, or is level; false: both fall.
HWY_INLINE bool rises_beside(const Edge& edge, Quad g, double limit, Side& side) {
  if (edge.facet[0] == kNone) return false;
  const Pair rates = side_rates(edge, g);
  if (rates[0] < limit && rates[1] < limit) return false;
  to_facet(side, edge.facet[rates[0] >= rates[1] ? 0 : 1]);
  return true;
}

inline std::int32_t common_facet(const Edge& first, const Edge& second) {
  for (const std::int32_t facet : first.facet) {
    if (facet != kNone && (facet == second.facet[0] || facet == second.facet[1])) return facet;
  }
  return kNone;
}

// From a vertex with no edge that rises for certain to what is level there: an edge, a facet of two
// level edges, or itself.
inline HWY_NOINLINE void to_level(const ConvexPolyhedron& body, Side& side, const Vec3& g,
                                  double limit) {
  const Vertex& vertex = body.vertices[side.feature];
  std::int32_t level = kNone;
  for (std::int32_t i = 0; i < vertex.edges; ++i) {
    if (!(body.outgoing_of(vertex, i).dot(g) >= limit)) continue;
    const std::int32_t edge = body.vertex_edges[vertex.first_edge + i].edge;
    if (level == kNone) {
      level = edge;
      to_edge(side, edge);
      continue;
    }
    const std::int32_t facet = common_facet(body.edges[level], body.edges[edge]);
    if (facet == kNone) continue;
    to_facet(side, facet);
    return;
  }
}

// The part of a line that lies within a facet's sides.
struct Span {
  double from, to;                     // along the line
  std::int32_t side[2]{kNone, kNone};  // the edges that end it; kNone: it ended there anyhow
  [[nodiscard]] bool empty() const { return !(from < to); }
  // Where it is empty: the line passes beyond this.
  std::int32_t beyond = kNone;
};

inline HWY_NOINLINE Span within(const ConvexPolyhedron& body, std::int32_t index, const Vec3& start,
                                const Vec3& direction, Span span) {
  const Facet& facet = body.facets[index];
  for (std::int32_t i = 0; i < facet.limits && !span.empty(); ++i) {
    const FacetLimit limit = body.limit_of(facet, i);
    const double speed = dot(limit.inward, direction),
                 gap = dot(limit.inward, start) - limit.offset;
    const std::int32_t edge = body.facet_edges[facet.first_side + i].edge;
    const double meets = -gap / speed;
    if (speed > 0.0 && meets > span.from) {
      span.from = meets;
      span.side[0] = edge;
    } else if (speed < 0.0 && meets < span.to) {
      span.to = meets;
      span.side[1] = edge;
    } else if (speed == 0.0 && gap < 0.0) {
      span.to = span.from;
    }
    if (span.empty()) span.beyond = edge;
  }
  return span;
}

// As std::clamp, but what is no number becomes `from`.
HWY_INLINE double clamped(double s, double from, double to) {
  return s >= from ? (to < s ? to : s) : from;
}

// Of the owner's edge, the part that faces the other's facet (or the other way round).
template <bool kMoved>
HWY_INLINE Span facing(const Owned<kMoved>& edge_of, const Edge& edge, std::int32_t facet) {
  return within(edge_of.other(), facet, vec3(edge_of.point_out(load3_of_4(edge.point))),
                vec3(edge_of.direction_out(load3_of_4(edge.direction))), {edge.begin, edge.end});
}

// Halfway between the last witness points, along an edge of the owner.
template <bool kMoved>
HWY_INLINE double halfway(const Owned<kMoved>& edge_of, Quad start, Quad direction) {
  const Quad mine = load3(edge_of.on_owner().point);
  const Quad theirs = edge_of.point_in(load3(edge_of.on_other().point));
  return dot(mine + 0.5 * (theirs - mine) - start, direction);
}

// The owner's edge on the other's facet.
template <bool kMoved>
inline HWY_NOINLINE Step edge_facet(const Owned<kMoved>& o) {
  const Edge& edge = o.owner().edges[o.on_owner().feature];
  const Facet& facet = o.other().facets[o.on_other().feature];
  if (!o.owner().bounded()) return Step::kLost;
  const Span span = facing(o, edge, o.on_other().feature);
  if (span.empty()) return to_edge(o.on_other(), span.beyond);
  const auto of_facet = o.opposite();
  const Quad start = load3_of_4(edge.point), e = load3_of_4(edge.direction),
             n = of_facet.direction_to_common(load3_of_4(facet.normal));
  const Quad down = -o.direction_to_own(n);
  const double rise = dot(e, down);
  if (!(std::abs(rise) <= kCertainRate)) {
    const int end = rise > 0.0 ? 1 : 0;
    if (span.side[end] != kNone) return to_edge(o.on_other(), span.side[end]);
    return to_vertex(o.on_owner(), edge.vertex[end]);
  }
  if (rises_beside(edge, down, -kCertainRate, o.on_owner())) return o.w.levelled();
  const double s = clamped(halfway(o, start, e), span.from, span.to);
  const Quad own = start + s * e, above = o.point_out(own);
  const double apart = of_facet.height(facet, own, above, n);
  if (!(apart > 0.0) && !o.w.overlapping) return Step::kLost;
  o.w.apart = apart;
  o.w.proved = apart - lost_by_tilt(o.w, std::abs(rise));
  of_facet.place_above(facet, apart, own, above, n);
  return Step::kHolds;
}

HWY_INLINE Quad onto(const Facet& facet, Quad p) {
  const Quad n = load3_of_4(facet.normal);
  return p - (dot(n, p) - facet.offset) * n;
}

// Halfway between the last witness points, on B's facet, in frame B. False: these were another
// pair's, far out on a half-space, or of bodies far apart, and so far off the facet's plane that
// rounding leaves `own` beside it.
HWY_INLINE bool halfway_on_facet(const Walk& w, const Facet& of_b, Quad& own) {
  const Quad mine = load3(w.on_b.point), n = load3_of_4(of_b.normal);
  const Quad theirs = point_to_b(w.a_from_b, load3(w.on_a.point));
  const Quad middle = mine + 0.5 * (theirs - mine);
  const double height = dot(n, middle) - of_b.offset;
  own = middle - height * n;
  const double size = (w.a.bounding_radius + w.b.bounding_radius) + w.a_from_b.apart;
  return std::abs(height) <= 2.0 * size && dot(own, own) < kInfinity;
}

// From a point that has passed the edge of the owner's facet back to it, in the owner's frame.
// False: no part of the edge faces the other's facet.
template <bool kMoved>
inline bool slide_back(const Owned<kMoved>& o, std::int32_t index, Quad& point) {
  const Edge& edge = o.owner().edges[index];
  const Span span = facing(o, edge, o.on_other().feature);
  if (span.empty()) {
    to_edge(o.on_owner(), index);
    return false;
  }
  const Quad start = load3_of_4(edge.point), e = load3_of_4(edge.direction);
  point = start + clamped(dot(point - start, e), span.from, span.to) * e;
  return true;
}

// The same for a point on B's facet that has passed an edge of A's, or else of B's.
inline HWY_NOINLINE bool slide_back(Walk& w, std::int32_t beyond_a, std::int32_t beyond_b,
                                    Quad& own) {
  if (beyond_a == kNone) return slide_back(Owned<true>{w}, beyond_b, own);
  Quad tip = point_to_a(w.a_from_b, own);
  if (!slide_back(Owned<false>{w}, beyond_a, tip)) return false;
  own = onto(w.b.facets[w.on_b.feature], point_to_b(w.a_from_b, tip));
  return true;
}

// The corner of the owner's facet that is farthest along g, in the owner's frame.
template <bool kMoved>
inline Step to_corner(const Owned<kMoved>& o, const Vec3& g) {
  const ConvexPolyhedron& body = o.owner();
  const Facet& facet = body.facets[o.on_owner().feature];
  double farthest = -kInfinity;
  std::int32_t corner = kNone;
  for (std::int32_t i = 0; i < facet.sides; ++i) {
    const EdgeUse& use = body.facet_edges[facet.first_side + i];
    for (const std::int32_t vertex : body.edges[use.edge].vertex) {
      if (vertex == kNone) continue;
      const double along = body.vertices[vertex].position.dot(g);
      if (!(along > farthest)) continue;
      farthest = along;
      corner = vertex;
    }
  }
  if (corner == kNone) return Step::kLost;
  return to_vertex(o.on_owner(), corner);
}

// Facets that are tilted: one's lowest corner comes first, preferably the smaller body's.
inline HWY_NOINLINE Step leave_facets(Walk& w, Quad n, Quad m) {
  if (!w.a.bounded() || (w.b.bounded() && w.b.bounding_radius > w.a.bounding_radius)) {
    return to_corner(Owned<false>{w}, vec3(-direction_to_a(w.a_from_b, m)));
  }
  return to_corner(Owned<true>{w}, vec3(-direction_to_b(w.a_from_b, n)));
}

inline HWY_NOINLINE Step facet_facet(Walk& w) {
  const Facet& of_a = w.a.facets[w.on_a.feature];
  const Facet& of_b = w.b.facets[w.on_b.feature];
  const Quad n = load3_of_4(of_a.normal), m = load3_of_4(of_b.normal);
  const Quad tilt = direction_to_b(w.a_from_b, n) + m;
  const double tilt2 = dot(tilt, tilt);
  if (HWY_UNLIKELY(!(tilt2 <= kLevelTilt * kLevelTilt))) return leave_facets(w, n, m);
  Quad own;
  if (HWY_UNLIKELY(!halfway_on_facet(w, of_b, own))) return Step::kLost;
  Quad tip = point_to_a(w.a_from_b, own);
  const std::int32_t beyond_a = side_beyond(w.a, of_a, tip);
  const std::int32_t beyond_b = beyond_a == kNone ? side_beyond(w.b, of_b, own) : kNone;
  if (HWY_UNLIKELY(beyond_a != kNone || beyond_b != kNone)) {
    if (!slide_back(w, beyond_a, beyond_b, own)) return Step::kMoved;
    tip = point_to_a(w.a_from_b, own);
  }
  w.apart = dot(n, tip) - of_a.offset;
  if (!(w.apart > 0.0) && !w.overlapping) return Step::kLost;
  w.own_b = own;
  w.point_b = tip;
  w.point_a = tip - w.apart * n;
  w.normal = n;
  w.proved = w.apart - lost_by_tilt(w, std::sqrt(tilt2));
  return Step::kHolds;
}

// Where parallel edges pass each other by, their facing ends are next.
inline Step to_facing_ends(Walk& w, const Edge& first, const Edge& second, bool after,
                           bool same_way) {
  to_vertex(w.on_a, first.vertex[after ? 1 : 0]);
  to_vertex(w.on_b, second.vertex[after == same_way ? 0 : 1]);
  return Step::kMoved;
}

// Of bounded bodies; `start_b` and f are B's edge in frame A.
inline HWY_NOINLINE Step parallel_edges(Walk& w, const Quad& start_b, const Quad& f) {
  const Edge& first = w.a.edges[w.on_a.feature];
  const Edge& second = w.b.edges[w.on_b.feature];
  const Quad start_a = load3_of_4(first.point), e = load3_of_4(first.direction);
  const double cosine = dot(e, f), begin = dot(start_b - start_a, e);
  const double end = begin + cosine * second.end;
  const double from = std::max(0.0, std::min(begin, end));
  const double to = std::min(first.end, std::max(begin, end));
  if (!(from < to)) return to_facing_ends(w, first, second, !(from < first.end), cosine > 0.0);
  const double s = clamped(halfway(Owned<false>{w}, start_a, e), from, to);
  w.point_a = start_a + s * e;
  w.own_b = load3_of_4(second.point) + ((s - begin) * cosine) * load3_of_4(second.direction);
  w.point_b = point_to_a(w.a_from_b, w.own_b);
  const Quad rough = w.point_b - w.point_a;
  const Quad g = rough - dot(rough, e) * e;  // what cancellation has left
  const double apart = norm(g), limit = -kCertainRate * apart;
  const bool on_a = rises_beside(first, g, limit, w.on_a);
  const bool on_b = rises_beside(second, -direction_to_b(w.a_from_b, g), limit, w.on_b);
  if (on_a || on_b) return w.levelled();
  w.normal = g / spread(apart);
  w.apart = apart;
  w.proved = apart - lost_by_tilt(w, std::abs(dot(w.normal, e)) + std::abs(dot(w.normal, f)));
  return Step::kHolds;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
