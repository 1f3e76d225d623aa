// Transitions of features that are parallel within tolerance: whole edges or facets are closest.
// Compiled once per vector width: see core/numerics/vec4-inl.hpp.
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
HWY_INLINE double tilt_error(const TrackedPair& pair, double tilt) {
  const double a = pair.a.bounded() ? pair.a.bounding_radius : kInfinity;
  const double b = pair.b.bounded() ? pair.b.bounding_radius : kInfinity;
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

// The facet beside both edges of a vertex. A segment's vertices have one edge each.
inline std::int32_t shared_facet(const Edge& first, const Edge& second) {
  for (const std::int32_t facet : first.facet) {
    if (facet == second.facet[0] || facet == second.facet[1]) return facet;
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
    const double crossing = -gap / speed;
    if (speed > 0.0 && crossing > span.from) {
      span.from = crossing;
      ends.side[0] = edge;
    } else if (speed < 0.0 && crossing < span.to) {
      span.to = crossing;
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
// kWider: of a facet that is wider by `margin`, m, on each side.
template <bool kWider>
HWY_INLINE Span within(const ConvexBody& body, const Facet& facet, Vec4 start, Vec4 direction,
                       Span span, double margin) {
  const double* four = body.facet_limits.row(facet.first_side);
  const Spread3 at(start), to(direction);
  const Vec4 zero = spread(0.0), none = spread(-kInfinity);
  for (std::int32_t i = 0; i < facet.limits; i += 4, four += kFourLimits) {
    const Vec4 speed = derivatives(four, to), inside = inside_limits(four, at);
    const Vec4 gap = kWider ? inside + spread(margin) : inside;
    const Vec4 crossing = -gap / speed;
    span.from = std::max(span.from, greatest(where_less(zero, speed, crossing, none)));
    span.to = std::min(span.to, -greatest(where_less(speed, zero, -crossing, none)));
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
  return within<false>(
      edge_of.other_body(), edge_of.other_body().facets[edge_of.other_side().feature],
      edge_of.point_L_to_O(load3_padded(edge.point)),
      edge_of.direction_L_to_O(load3_padded(edge.direction)), {edge.begin, edge.end}, 0.0);
}
template <bool kIsB>
HWY_INLINE SpanEnds facing_ends(const Owner<kIsB>& edge_of, const Edge& edge) {
  return ends_within(edge_of.other_body(), edge_of.other_side().feature,
                     vec3(edge_of.point_L_to_O(load3_padded(edge.point))),
                     vec3(edge_of.direction_L_to_O(load3_padded(edge.direction))),
                     {edge.begin, edge.end});
}

// m: a point that is no farther past the end of a feature may be on it.
HWY_INLINE double beside_margin(const TrackedPair& pair) { return 8 * kUlp * size_of(pair); }

// The part of an edge, whose body has this frame, that faces a facet which is wider by `margin`.
template <bool kIsB>
inline HWY_NOINLINE Span facing_wider(const RelativePose4& a_from_b, const Edge& edge,
                                      const ConvexBody& other, const Facet& facet, double margin) {
  const BodyFrame<kIsB> frame{a_from_b};
  return within<true>(other, facet, frame.point_L_to_O(load3_padded(edge.point)),
                      frame.direction_L_to_O(load3_padded(edge.direction)), {edge.begin, edge.end},
                      margin);
}

// The part of the owner's edge that lies along a side of the facet or meets a corner of it, where
// rounding leaves no part that faces it. Bodies that touched are left to their own transitions.
template <bool kIsB>
HWY_INLINE Span beside(const Owner<kIsB>& edge_of, const Edge& edge) {
  if (edge_of.pair.penetrating) return {0.0, 0.0};
  return facing_wider<kIsB>(in_memory(edge_of.a_from_b), edge, edge_of.other_body(),
                            edge_of.other_body().facets[edge_of.other_side().feature],
                            beside_margin(edge_of.pair));
}

// m: the distance of a point from a feature may be greater than its distance from the plane or line
// of the feature by this, if the point is beside the feature.
HWY_INLINE double beyond(const TrackedPair& pair, double distance) {
  const double margin = beside_margin(pair);
  return margin * margin / distance;
}

// The place along an edge of the owner that is halfway between the last witness points.
template <bool kIsB>
HWY_INLINE double halfway(const Owner<kIsB>& edge_of, Vec4 start, Vec4 direction) {
  const Vec4 mine = load3(edge_of.side().point);
  const Vec4 theirs = edge_of.point_O_to_L(load3(edge_of.other_side().point));
  return dot(mine + 0.5 * (theirs - mine) - start, direction);
}

// The owner's edge and the other body's facet are parallel.
template <bool kIsB>
inline HWY_NOINLINE Transition edge_facet(const Owner<kIsB>& owner) {
  const Edge& edge = owner.body().edges[owner.side().feature];
  const Facet& facet = owner.other_body().facets[owner.other_side().feature];
  if (!owner.body().bounded()) return Transition::kUndecided;
  Span span = facing(owner, edge);
  const bool is_beside = span.empty();
  if (is_beside) {
    span = beside(owner, edge);
    if (span.empty()) return to_edge(owner.other_side(), facing_ends(owner, edge).next_edge);
  }
  const auto plane = plane_of(owner.opposite(), facet);
  const Vec4 start = load3_padded(edge.point), e = load3_padded(edge.direction);
  const Vec4 down = -owner.direction_A_to_L(plane.n_A);
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
  const Vec4 local = start + s * e, above = owner.point_L_to_O(local);
  const double distance = plane.height(local, above);
  owner.pair.found.distance = distance;
  if (!(distance > 0.0) && !owner.pair.penetrating) return Transition::kUndecided;
  owner.pair.found.certified = distance - tilt_error(owner.pair, std::abs(along));
  plane.place_witnesses(owner.pair.found, local, above);
  if (HWY_UNLIKELY(is_beside)) owner.pair.found.distance += beyond(owner.pair, distance);
  return Transition::kClosest;
}

// The point of B's facet halfway between the last witness points, in frame B. False: these points
// are so far off the plane of the facet that rounding leaves `local` off the plane. They may be
// those of another pair, or far out on a half-space.
HWY_INLINE bool halfway_on_facet(const TrackedPair& pair, const Facet& facet_b, Vec4& local) {
  const Vec4 mine = load3(pair.on_b.point), n = load3_padded(facet_b.normal);
  const Vec4 theirs = point_to_b(pair.a_from_b, load3(pair.on_a.point));
  const Vec4 middle = mine + 0.5 * (theirs - mine);
  const double height = dot(n, middle) - facet_b.offset;
  local = middle - height * n;
  return std::abs(height) <= 2.0 * size_of(pair) && dot(local, local) < kInfinity;
}

enum class SlideBack {
  kFacing,
  kBeside,  // the point is beside the facet of the other body
  kNowhere,
};

// Moves a point that has passed an edge of the owner's facet back to that edge, in the owner's
// frame. kNowhere: no part of the edge faces the facet of the other body.
template <bool kIsB>
HWY_INLINE SlideBack slide_back(const Owner<kIsB>& owner, std::int32_t index, Vec4& point) {
  const Edge& edge = owner.body().edges[index];
  Span span = facing(owner, edge);
  const bool is_beside = span.empty();
  if (HWY_UNLIKELY(is_beside)) {
    span = beside(owner, edge);
    if (span.empty()) {
      to_edge(owner.side(), index);
      return SlideBack::kNowhere;
    }
  }
  const Vec4 start = load3_padded(edge.point), e = load3_padded(edge.direction);
  point = start + clamped(dot(point - start, e), span.from, span.to) * e;
  return is_beside ? SlideBack::kBeside : SlideBack::kFacing;
}

// The same for a point on B's facet that has passed an edge of A's facet, or else one of B's.
HWY_INLINE SlideBack slide_back(TrackedPair& pair, std::int32_t crossed_a, std::int32_t crossed_b,
                                Vec4& local) {
  if (crossed_a == kNone) return slide_back(Owner<true>(pair), crossed_b, local);
  Vec4 tip = point_to_a(pair.a_from_b, local);
  const SlideBack back = slide_back(Owner<false>(pair), crossed_a, tip);
  local = onto(pair.b.facets[pair.on_b.feature], point_to_b(pair.a_from_b, tip));
  return back;
}

// Moves to the vertex of the body's facet that is the support point along g, in the body's frame.
inline Transition to_support_vertex(const ConvexBody& body, Side& side, const Vec3& g) {
  const Facet& facet = body.facets[side.feature];
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
  return to_vertex(side, support);
}

// For facets that are tilted against each other. The vertex of one that is lowest above the other
// takes over, preferably that of the smaller body. Each g leads to the other facet, in its body's
// frame.
inline HWY_NOINLINE Transition leave_facets(const ConvexBody& a, const ConvexBody& b, Side& on_a,
                                            Side& on_b, Vec4 g_of_a, Vec4 g_of_b) {
  const bool larger_b = b.bounded() && b.bounding_radius > a.bounding_radius;
  return !a.bounded() || larger_b ? to_support_vertex(a, on_a, vec3(g_of_a))
                                  : to_support_vertex(b, on_b, vec3(g_of_b));
}

HWY_INLINE Transition facet_facet(TrackedPair& pair) {
  const Facet& facet_a = pair.a.facets[pair.on_a.feature];
  const Facet& facet_b = pair.b.facets[pair.on_b.feature];
  const Vec4 n = load3_padded(facet_a.normal), m = load3_padded(facet_b.normal);
  const Vec4 tilt = direction_to_b(pair.a_from_b, n) + m;
  const double tilt2 = dot(tilt, tilt);
  if (HWY_UNLIKELY(!(tilt2 <= kParallelTilt * kParallelTilt))) {
    return leave_facets(pair.a, pair.b, pair.on_a, pair.on_b, -direction_to_a(pair.a_from_b, m),
                        -direction_to_b(pair.a_from_b, n));
  }
  Vec4 local;
  if (HWY_UNLIKELY(!halfway_on_facet(pair, facet_b, local))) return Transition::kUndecided;
  Vec4 tip = point_to_a(pair.a_from_b, local);
  const std::int32_t crossed_a = crossed_side(pair.a, facet_a, tip);
  const std::int32_t crossed_b = crossed_a == kNone ? crossed_side(pair.b, facet_b, local) : kNone;
  auto back = SlideBack::kFacing;
  if (HWY_UNLIKELY(crossed_a != kNone || crossed_b != kNone)) {
    const Vec4 before = local;
    if (!slide_back_on_boxes(pair.a, pair.b, in_memory(pair.a_from_b), facet_a, facet_b, local)) {
      local = before;
      back = slide_back(pair, crossed_a, crossed_b, local);
      if (back == SlideBack::kNowhere) return Transition::kMoved;
    }
    tip = point_to_a(pair.a_from_b, local);
  }
  pair.found.distance = dot(n, tip) - facet_a.offset;
  if (!(pair.found.distance > 0.0) && !pair.penetrating) return Transition::kUndecided;
  pair.found.b_B = local;
  pair.found.b_A = tip;
  pair.found.a_A = tip - pair.found.distance * n;
  pair.found.n_A = n;
  pair.found.certified = pair.found.distance - tilt_error(pair, std::sqrt(tilt2));
  if (HWY_UNLIKELY(back == SlideBack::kBeside)) {
    pair.found.distance += beyond(pair, pair.found.distance);
  }
  return Transition::kClosest;
}

// For parallel edges that face each other nowhere: the ends that are nearest to each other are
// next.
inline Transition to_facing_ends(Side& on_a, Side& on_b, const Edge& first, const Edge& second,
                                 bool after, bool same_direction) {
  to_vertex(on_a, first.vertex[after ? 1 : 0]);
  to_vertex(on_b, second.vertex[after == same_direction ? 0 : 1]);
  return Transition::kMoved;
}

// The bodies are bounded; `start_b` and f are B's edge in frame A.
HWY_INLINE Transition parallel_edges(TrackedPair& pair, Vec4 start_b, Vec4 f) {
  const Edge& first = pair.a.edges[pair.on_a.feature];
  const Edge& second = pair.b.edges[pair.on_b.feature];
  const Vec4 start_a = load3_padded(first.point), e = load3_padded(first.direction);
  const double cosine = dot(e, f), begin = dot(start_b - start_a, e);
  const double end = begin + cosine * second.end;
  const double from = std::max(0.0, std::min(begin, end));
  const double to = std::min(first.end, std::max(begin, end));
  const bool is_beside =
      HWY_UNLIKELY(!(from < to)) && from - to <= beside_margin(pair) && !pair.penetrating;
  if (HWY_UNLIKELY(!(from < to)) && !is_beside) {
    return to_facing_ends(pair.on_a, pair.on_b, first, second, !(from < first.end), cosine > 0.0);
  }
  const double s = is_beside ? clamped(from, 0.0, first.end)
                             : clamped(halfway(Owner<false>(pair), start_a, e), from, to);
  pair.found.a_A = start_a + s * e;
  pair.found.b_B =
      load3_padded(second.point) + ((s - begin) * cosine) * load3_padded(second.direction);
  pair.found.b_A = point_to_a(pair.a_from_b, pair.found.b_B);
  const Vec4 rough = pair.found.b_A - pair.found.a_A;
  const Vec4 g = rough - dot(rough, e) * e;  // without the part along e that cancellation has left
  const double distance = norm(g), limit = -kDerivativeError * distance;
  const bool on_a = to_approaching_facet(first, g, limit, pair.on_a);
  const bool on_b =
      to_approaching_facet(second, -direction_to_b(pair.a_from_b, g), limit, pair.on_b);
  if (on_a || on_b) return pair.parallel();
  pair.found.n_A = g / spread(distance);
  pair.found.distance = distance;
  pair.found.certified = distance - tilt_error(pair, std::abs(dot(pair.found.n_A, e)) +
                                                         std::abs(dot(pair.found.n_A, f)));
  if (is_beside) pair.found.distance += beyond(pair, distance);
  return Transition::kClosest;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
