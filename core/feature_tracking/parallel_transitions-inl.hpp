// Transitions of features that are parallel within tolerance: whole edges or facets are closest.
// Compiled once a vector width: see core/numerics/vec4-inl.hpp.
//
// Any pair of points that face each other would be a closest pair. The point halfway between the
// last witness points of both bodies moves no faster than the bodies, and mostly lies within both
// features. If it does not, the nearest point on the side that it has passed takes its place. The
// certified distance is reduced for the tilt of the normal against the features.
#if defined(CLEARANCE_CORE_PARALLEL_TRANSITIONS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_PARALLEL_TRANSITIONS
#undef CLEARANCE_CORE_PARALLEL_TRANSITIONS
#else
#define CLEARANCE_CORE_PARALLEL_TRANSITIONS
#endif

#include <algorithm>
#include <cmath>

#include "core/feature_tracking/starts-inl.hpp"
#include "core/model/edge_scan-inl.hpp"
#include "core/numerics/error_constants.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// m: the amount by which the certified distance is reduced if the normal is off a right angle to a
// feature by `tilt`. The tilt may change a support value over the whole size of a body. It is
// enough to count the smaller body.
template <bool kBounded = false>
HWY_INLINE double tilt_error(const TrackedPair& pair, double tilt) {
  const double a = kBounded || pair.a.bounded() ? pair.a.bounding_radius : kInfinity;
  const double b = kBounded || pair.b.bounded() ? pair.b.bounding_radius : kInfinity;
  return 2.0 * std::min(a, b) * (tilt + kTiltError);
}

// Moves from an edge to the facet beside it that does not recede along g by more than rounding.
// False: both recede.
HWY_INLINE bool to_approaching_facet(const Edge& edge, Vec4 g, double limit, Side& side) {
  if (edge.facet[0] == kNone) return false;
  const Vec2 along = facet_derivatives(edge, g);
  if (along[0] < limit && along[1] < limit) return false;
  to_facet(side, edge.facet[along[0] >= along[1] ? 0 : 1]);
  return true;
}

inline std::int32_t shared_facet(const Edge& first, const Edge& second) {
  for (const std::int32_t facet : first.facet) {
    if (facet != kNone && (facet == second.facet[0] || facet == second.facet[1])) return facet;
  }
  return kNone;
}

// For a vertex of which no edge approaches by more than rounding. Moves to the feature that is
// orthogonal to g there: an edge, the facet of two such edges, or the vertex itself.
inline HWY_NOINLINE void to_parallel(const ConvexBody& body, Side& side, const Vec3& g,
                                     double limit) {
  const Vertex& vertex = body.vertices[side.feature];
  std::int32_t orthogonal = kNone;
  for (std::int32_t i = 0; i < vertex.edges; ++i) {
    if (!(body.outgoing_of(vertex, i).dot(g) >= limit)) continue;
    const std::int32_t edge = body.vertex_edges[vertex.first_edge + i].edge;
    if (orthogonal == kNone) {
      orthogonal = edge;
      to_edge(side, edge);
      continue;
    }
    const std::int32_t facet = shared_facet(body.edges[orthogonal], body.edges[edge]);
    if (facet == kNone) continue;
    to_facet(side, facet);
    return;
  }
}

// The part of a line that lies within a facet's sides.
struct Span {
  double from, to;  // along the line
  [[nodiscard]] HWY_INLINE bool empty() const { return !(from < to); }
};

// The edges that end a span; kNone: the line itself began or ended there.
struct SpanEnds {
  std::int32_t side[2]{kNone, kNone};
  // If the span is empty: the edge that the line passes by.
  std::int32_t next_edge = kNone;
};

// The edges that cut the span, in their order around the facet.
inline HWY_NOINLINE SpanEnds ends_within(const ConvexBody& body, std::int32_t index,
                                         const Vec3& start, const Vec3& direction, Span span) {
  SpanEnds ends;
  const Facet& facet = body.facets[index];
  for (std::int32_t i = 0; i < facet.limits && !span.empty(); ++i) {
    const FacetLimit limit = body.limit_of(facet, i);
    const double speed = dot(limit.inward, direction),
                 gap = dot(limit.inward, start) - limit.offset;
    const std::int32_t edge = body.facet_edges[facet.first_side + i].edge;
    const double meets = -gap / speed;
    if (speed > 0.0 && meets > span.from) {
      span.from = meets;
      ends.side[0] = edge;
    } else if (speed < 0.0 && meets < span.to) {
      span.to = meets;
      ends.side[1] = edge;
    } else if (speed == 0.0 && gap < 0.0) {
      span.to = span.from;
    }
    if (span.empty()) ends.next_edge = edge;
  }
  return ends;
}

HWY_INLINE double greatest(Vec4 v) {
  return std::max(std::max(lane(v, 0), lane(v, 1)), std::max(lane(v, 2), lane(v, 3)));
}

// The same span without its edges, four sides at a time and without a branch on any of them.
HWY_INLINE Span within(const ConvexBody& body, const Facet& facet, Vec4 start, Vec4 direction,
                       Span span) {
  const double* four = body.facet_limits.row(facet.first_side);
  const Spread3 at(start), to(direction);
  const Vec4 zero = spread(0.0), none = spread(-kInfinity);
  for (std::int32_t i = 0; i < facet.limits; i += 4, four += kFourLimits) {
    const Vec4 speed = derivatives(four, to), gap = inside_limits(four, at);
    const Vec4 meets = -gap / speed;
    span.from = std::max(span.from, greatest(where_less(zero, speed, meets, none)));
    span.to = std::min(span.to, -greatest(where_less(speed, zero, -meets, none)));
    const unsigned moving = less(zero, speed) | less(speed, zero);
    if (HWY_UNLIKELY((less(gap, zero) & ~moving) != 0)) span.to = span.from;
  }
  return span;
}

// The same as std::clamp, but NaN becomes `from`.
HWY_INLINE double clamped(double s, double from, double to) {
  return s >= from ? (to < s ? to : s) : from;
}

// The part of the owner's edge that faces the facet of the other body.
template <bool kIsB>
HWY_INLINE Span facing(const Owner<kIsB>& edge_of, const Edge& edge) {
  return within(edge_of.other_body(), edge_of.other_body().facets[edge_of.other_side().feature],
                edge_of.point_to_other(load3_of_4(edge.point)),
                edge_of.direction_to_other(load3_of_4(edge.direction)), {edge.begin, edge.end});
}
template <bool kIsB>
HWY_INLINE SpanEnds facing_ends(const Owner<kIsB>& edge_of, const Edge& edge) {
  return ends_within(edge_of.other_body(), edge_of.other_side().feature,
                     vec3(edge_of.point_to_other(load3_of_4(edge.point))),
                     vec3(edge_of.direction_to_other(load3_of_4(edge.direction))),
                     {edge.begin, edge.end});
}

// The place along an edge of the owner that is halfway between the last witness points.
template <bool kIsB>
HWY_INLINE double halfway(const Owner<kIsB>& edge_of, Vec4 start, Vec4 direction) {
  const Vec4 mine = load3(edge_of.side().point);
  const Vec4 theirs = edge_of.point_from_other(load3(edge_of.other_side().point));
  return dot(mine + 0.5 * (theirs - mine) - start, direction);
}

// The owner's edge and the other body's facet are parallel.
template <bool kIsB>
inline HWY_NOINLINE Transition edge_facet(const Owner<kIsB>& owner) {
  const Edge& edge = owner.body().edges[owner.side().feature];
  const Facet& facet = owner.other_body().facets[owner.other_side().feature];
  if (!owner.body().bounded()) return Transition::kUndecided;
  const Span span = facing(owner, edge);
  if (span.empty()) return to_edge(owner.other_side(), facing_ends(owner, edge).next_edge);
  const auto plane = plane_of(owner.opposite(), facet);
  const Vec4 start = load3_of_4(edge.point), e = load3_of_4(edge.direction);
  const Vec4 down = -owner.direction_in_local(plane.n);
  const double along = dot(e, down);
  if (!(std::abs(along) <= kDerivativeError)) {
    const int end = along > 0.0 ? 1 : 0;
    const std::int32_t side = facing_ends(owner, edge).side[end];
    if (side != kNone) return to_edge(owner.other_side(), side);
    return to_vertex(owner.side(), edge.vertex[end]);
  }
  if (to_approaching_facet(edge, down, -kDerivativeError, owner.side()))
    return owner.pair.parallel();
  const double s = clamped(halfway(owner, start, e), span.from, span.to);
  const Vec4 local = start + s * e, above = owner.point_to_other(local);
  const double distance = plane.height(local, above);
  owner.pair.distance = distance;
  if (!(distance > 0.0) && !owner.pair.penetrating) return Transition::kUndecided;
  owner.pair.certified = distance - tilt_error(owner.pair, std::abs(along));
  plane.place_witnesses(owner.pair, local, above);
  return Transition::kClosest;
}

HWY_INLINE Vec4 onto(const Facet& facet, Vec4 p) {
  const Vec4 n = load3_of_4(facet.normal);
  return p - (dot(n, p) - facet.offset) * n;
}

// The point of B's facet halfway between the last witness points, in frame B. False: these points
// are so far off the plane of the facet that rounding leaves `local` off the plane. They may be
// those of another pair, or far out on a half-space.
HWY_INLINE bool halfway_on_facet(const TrackedPair& pair, const Facet& of_b, Vec4& local) {
  const Vec4 mine = load3(pair.on_b.point), n = load3_of_4(of_b.normal);
  const Vec4 theirs = point_to_b(pair.a_from_b, load3(pair.on_a.point));
  const Vec4 middle = mine + 0.5 * (theirs - mine);
  const double height = dot(n, middle) - of_b.offset;
  local = middle - height * n;
  const double size =
      (pair.a.bounding_radius + pair.b.bounding_radius) + pair.a_from_b.translation_length;
  return std::abs(height) <= 2.0 * size && dot(local, local) < kInfinity;
}

// Moves a point that has passed an edge of the owner's facet back to that edge, in the owner's
// frame. False: no part of the edge faces the facet of the other body.
template <bool kIsB>
HWY_INLINE bool slide_back(const Owner<kIsB>& owner, std::int32_t index, Vec4& point) {
  const Edge& edge = owner.body().edges[index];
  const Span span = facing(owner, edge);
  if (HWY_UNLIKELY(span.empty())) {
    to_edge(owner.side(), index);
    return false;
  }
  const Vec4 start = load3_of_4(edge.point), e = load3_of_4(edge.direction);
  point = start + clamped(dot(point - start, e), span.from, span.to) * e;
  return true;
}

// The same for a point on B's facet that has passed an edge of A's facet, or else one of B's.
HWY_INLINE bool slide_back(TrackedPair& pair, std::int32_t crossed_a, std::int32_t crossed_b,
                           Vec4& local) {
  if (crossed_a == kNone) return slide_back(Owner<true>(pair), crossed_b, local);
  Vec4 tip = point_to_a(pair.a_from_b, local);
  if (!slide_back(Owner<false>(pair), crossed_a, tip)) return false;
  local = onto(pair.b.facets[pair.on_b.feature], point_to_b(pair.a_from_b, tip));
  return true;
}

// Clamps a point of a box's facet, in the box's frame, along the two axes of the facet.
HWY_INLINE Vec4 clamped_to_facet(const BoxFeatures& box, Vec4 n, Vec4 p) {
  const Vec4 centre = load3_of_4(box.centre), half = load3_of_4(box.half);
  const Vec4 low = centre - half, high = centre + half;
  const Vec4 within = where_less(high, p, high, where_less(p, low, low, p));
  return where_less(spread(0.5), n * n, p, within);
}

// Does what slide_back() does, by two clamps, for two boxes that share all axes. The first clamp is
// onto the facet of A, the second one onto that of B. Returns false if a body is no box, or if the
// boxes do not share all axes. Also returns false if the second clamp moves the point out of A's
// facet: the facets then do not face each other there.
inline HWY_NOINLINE bool slide_back_on_boxes(const TrackedPair& pair, const Facet& of_a,
                                             const Facet& of_b, Vec4& local) {
  const BoxFeatures &a = pair.a.box, &b = pair.b.box;
  if (!a.exist() || !b.exist() || shared_axes(squares_of(pair.a_from_b.rotation)) != 7u) {
    return false;
  }
  const Vec4 n = load3_of_4(of_a.normal);
  const Vec4 on_a = clamped_to_facet(a, n, point_to_a(pair.a_from_b, local));
  const Vec4 on_b =
      clamped_to_facet(b, load3_of_4(of_b.normal), onto(of_b, point_to_b(pair.a_from_b, on_a)));
  const Vec4 again = point_to_a(pair.a_from_b, on_b);
  const Vec4 off = again - clamped_to_facet(a, n, again);
  const double rounding = 0x1p-50 * (pair.a.bounding_radius + pair.b.bounding_radius);
  local = on_b;
  return dot(off, off) <= rounding * rounding;
}

// Moves to the vertex of the owner's facet that is the support point along g, in the owner's frame.
template <bool kIsB>
inline Transition to_support_vertex(const Owner<kIsB>& owner, const Vec3& g) {
  const ConvexBody& body = owner.body();
  const Facet& facet = body.facets[owner.side().feature];
  double farthest = -kInfinity;
  std::int32_t support = kNone;
  for (std::int32_t i = 0; i < facet.sides; ++i) {
    const EdgeUse& use = body.facet_edges[facet.first_side + i];
    for (const std::int32_t vertex : body.edges[use.edge].vertex) {
      if (vertex == kNone) continue;
      const double along = body.vertices[vertex].position.dot(g);
      if (!(along > farthest)) continue;
      farthest = along;
      support = vertex;
    }
  }
  if (support == kNone) return Transition::kUndecided;
  return to_vertex(owner.side(), support);
}

// For facets that are tilted against each other. The vertex of one that is lowest above the other
// takes over, preferably that of the smaller body.
inline HWY_NOINLINE Transition leave_facets(TrackedPair& pair, Vec4 n, Vec4 m) {
  if (!pair.a.bounded() || (pair.b.bounded() && pair.b.bounding_radius > pair.a.bounding_radius)) {
    return to_support_vertex(Owner<false>(pair), vec3(-direction_to_a(pair.a_from_b, m)));
  }
  return to_support_vertex(Owner<true>(pair), vec3(-direction_to_b(pair.a_from_b, n)));
}

// `kMode`: see transition().
template <Tracking kMode>
HWY_INLINE Transition facet_facet(TrackedPair& pair) {
  const Facet& of_a = pair.a.facets[pair.on_a.feature];
  const Facet& of_b = pair.b.facets[pair.on_b.feature];
  const Vec4 n = load3_of_4(of_a.normal), m = load3_of_4(of_b.normal);
  const Vec4 tilt = direction_to_b(pair.a_from_b, n) + m;
  const double tilt2 = dot(tilt, tilt);
  if (HWY_UNLIKELY(!(tilt2 <= kParallelTilt * kParallelTilt))) {
    if constexpr (kMode != Tracking::kFurther) return Transition::kDeferred;
    return leave_facets(pair, n, m);
  }
  Vec4 local;
  if (HWY_UNLIKELY(!halfway_on_facet(pair, of_b, local))) return Transition::kUndecided;
  Vec4 tip = point_to_a(pair.a_from_b, local);
  const std::int32_t crossed_a = crossed_side(pair.a, of_a, tip);
  const std::int32_t crossed_b = crossed_a == kNone ? crossed_side(pair.b, of_b, local) : kNone;
  if (HWY_UNLIKELY(crossed_a != kNone || crossed_b != kNone)) {
    const Vec4 before = local;
    if (!slide_back_on_boxes(pair, of_a, of_b, local)) {
      local = before;
      if (!slide_back(pair, crossed_a, crossed_b, local)) return Transition::kMoved;
    }
    tip = point_to_a(pair.a_from_b, local);
  }
  pair.distance = dot(n, tip) - of_a.offset;
  if (!(pair.distance > 0.0) && !pair.penetrating) return Transition::kUndecided;
  pair.local_b = local;
  pair.point_b = tip;
  pair.point_a = tip - pair.distance * n;
  pair.normal = n;
  pair.certified =
      pair.distance - tilt_error<kMode == Tracking::kFirstOfPlain>(pair, std::sqrt(tilt2));
  return Transition::kClosest;
}

// For parallel edges that face each other nowhere: the ends that are nearest to each other are
// next.
inline Transition to_facing_ends(Side& on_a, Side& on_b, const Edge& first, const Edge& second,
                                 bool after, bool same_way) {
  to_vertex(on_a, first.vertex[after ? 1 : 0]);
  to_vertex(on_b, second.vertex[after == same_way ? 0 : 1]);
  return Transition::kMoved;
}

// The bodies are bounded; `start_b` and f are B's edge in frame A.
HWY_INLINE Transition parallel_edges(TrackedPair& pair, Vec4 start_b, Vec4 f) {
  const Edge& first = pair.a.edges[pair.on_a.feature];
  const Edge& second = pair.b.edges[pair.on_b.feature];
  const Vec4 start_a = load3_of_4(first.point), e = load3_of_4(first.direction);
  const double cosine = dot(e, f), begin = dot(start_b - start_a, e);
  const double end = begin + cosine * second.end;
  const double from = std::max(0.0, std::min(begin, end));
  const double to = std::min(first.end, std::max(begin, end));
  if (!(from < to)) {
    return to_facing_ends(pair.on_a, pair.on_b, first, second, !(from < first.end), cosine > 0.0);
  }
  const double s = clamped(halfway(Owner<false>(pair), start_a, e), from, to);
  pair.point_a = start_a + s * e;
  pair.local_b = load3_of_4(second.point) + ((s - begin) * cosine) * load3_of_4(second.direction);
  pair.point_b = point_to_a(pair.a_from_b, pair.local_b);
  const Vec4 rough = pair.point_b - pair.point_a;
  const Vec4 g = rough - dot(rough, e) * e;  // without the part along e that cancellation has left
  const double distance = norm(g), limit = -kDerivativeError * distance;
  const bool on_a = to_approaching_facet(first, g, limit, pair.on_a);
  const bool on_b =
      to_approaching_facet(second, -direction_to_b(pair.a_from_b, g), limit, pair.on_b);
  if (on_a || on_b) return pair.parallel();
  pair.normal = g / spread(distance);
  pair.distance = distance;
  pair.certified =
      distance - tilt_error(pair, std::abs(dot(pair.normal, e)) + std::abs(dot(pair.normal, f)));
  return Transition::kClosest;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
