// The walk of core/feature_walk/feature_walk.hpp, compiled once a vector width: see
// core/numerics/vec4-inl.hpp.
#if defined(CLEARANCE_CORE_FEATURE_WALK) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_FEATURE_WALK
#undef CLEARANCE_CORE_FEATURE_WALK
#else
#define CLEARANCE_CORE_FEATURE_WALK
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/feature_walk/feature_walk.hpp"
#include "core/feature_walk/parallel_steps-inl.hpp"
#include "core/model/error_bounds.hpp"
#include "core/numerics/error_constants.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {
// Enough for 99.9 % of the tracked queries of the facet-ball workload; more is the loop's work.
inline constexpr int kSteps = 24;

// From a vertex along an edge that approaches the other's point: onto the edge, or past it to its
// far end.
inline Step leave_vertex(const ConvexPolyhedron& body, Side& side, const SteepestEdge& way) {
  const EdgeUse& use = body.vertex_edges[way.at];
  const Edge& edge = body.edges[use.edge];
  if (way.rate >= edge.end && edge.vertex[1 - use.side] != kNone) {
    return to_vertex(side, edge.vertex[1 - use.side]);
  }
  return to_edge(side, use.edge);
}

// False: none approaches for certain, and both sides come to what is level.
inline HWY_NOINLINE bool leave_either(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                      const Vertex& of_a, const Vertex& of_b, Side& on_a,
                                      Side& on_b, Quad g, Quad back, double limit) {
  const SteepestEdge from_a = steepest(a, of_a, g), from_b = steepest(b, of_b, back);
  if (from_a.rate > -limit && from_a.rate >= from_b.rate) {
    return leave_vertex(a, on_a, from_a) == Step::kMoved;
  }
  if (from_b.rate > -limit) return leave_vertex(b, on_b, from_b) == Step::kMoved;
  to_level(a, on_a, vec3(g), limit);
  to_level(b, on_b, vec3(back), limit);
  return false;
}

HWY_INLINE Step vertex_vertex(Walk& w) {
  const Vertex& of_a = w.a.vertices[w.on_a.feature];
  const Vertex& of_b = w.b.vertices[w.on_b.feature];
  w.point_a = load3_alone(of_a.position);
  w.own_b = load3_alone(of_b.position);
  w.point_b = point_to_a(w.a_from_b, w.own_b);
  const Quad g = w.point_b - w.point_a, back = -direction_to_b(w.a_from_b, g);
  const double apart = norm(g), limit = -kCertainRate * apart;
  if (!all_fall(w.a, of_a, g, limit) || !all_fall(w.b, of_b, back, limit)) {
    return leave_either(w.a, w.b, of_a, of_b, w.on_a, w.on_b, g, back, limit) ? Step::kMoved
                                                                              : w.levelled();
  }
  w.apart = w.proved = apart;
  w.normal = g / spread(apart);
  return Step::kHolds;
}

// In frame A, where B is what the rotation's doubles make of it: not quite rigid, and so neither
// are its unit vectors of unit length. Seen from B it would be A that is stretched, however far
// away.
template <bool kMoved>
HWY_INLINE Step edge_vertex(const Owned<kMoved>& o) {
  const Edge& edge = o.owner().edges[o.on_owner().feature];
  const Vertex& vertex = o.other().vertices[o.on_other().feature];
  const Quad own_tip = load3_alone(vertex.position), own_start = load3_of_4(edge.point),
             own_e = load3_of_4(edge.direction);
  const Quad tip = o.opposite().point_to_common(own_tip), start = o.point_to_common(own_start),
             e = o.direction_to_common(own_e);
  const Quad from_start = tip - start;
  const double s = dot(from_start, e) * (kMoved ? over_square(e) : 1.0);
  if (!(s > edge.begin)) return to_vertex(o.on_owner(), edge.vertex[0]);
  if (!(s < edge.end)) return to_vertex(o.on_owner(), edge.vertex[1]);
  // As long as the way from the edge to the vertex, and at right angles to it; then that way. No
  // difference of long vectors: cancellation leaves nothing along the edge.
  const Quad across = cross(from_start, e), way = cross(e, across);
  const double length = norm(across), limit = -kCertainRate * length;
  const Quad g = o.direction_to_own(way), back = -o.opposite().direction_to_own(way);
  if (!sides_fall(edge, g, limit)) {
    rises_beside(edge, g, limit, o.on_owner());
    const Pair rates = side_rates(edge, g);
    if (std::max(rates[0], rates[1]) > -limit) return Step::kMoved;
    to_level(o.other(), o.on_other(), vec3(back), limit);
    return o.w.levelled();
  }
  if (!all_fall(o.other(), vertex, back, limit)) {
    const SteepestEdge away = steepest(o.other(), vertex, back);
    if (!(away.rate > -limit)) {
      to_level(o.other(), o.on_other(), vec3(back), limit);
      return o.w.levelled();
    }
    return to_edge(o.on_other(), o.other().vertex_edges[away.at].edge);
  }
  const double unit = kMoved ? over_norm(e) : 1.0;
  const double of_way = HWY_UNLIKELY(length < kSlender * std::abs(s)) ? norm(way) / unit : length;
  o.w.apart = o.w.proved = unit * length;
  o.w.normal = (kMoved ? -unit : 1.0) * way / spread(of_way);
  o.place(own_start + s * own_e, start + s * e, own_tip, tip);
  return Step::kHolds;
}

template <bool kMoved>
HWY_INLINE Step facet_vertex(const Owned<kMoved>& o) {
  const Facet& facet = o.owner().facets[o.on_owner().feature];
  const Vertex& vertex = o.other().vertices[o.on_other().feature];
  const Quad tip = load3_alone(vertex.position), own_tip = o.point_in(tip);
  const Quad n = o.direction_to_common(load3_of_4(facet.normal));
  const double apart = o.height(facet, tip, own_tip, n);
  if (HWY_UNLIKELY(!(apart > 0.0)) && !o.w.overlapping) return Step::kLost;
  const std::int32_t beyond = side_beyond(o.owner(), facet, own_tip);
  if (beyond != kNone) return to_edge(o.on_owner(), beyond);
  const Quad back = -o.opposite().direction_to_own(n);
  if (!all_fall(o.other(), vertex, back, -kCertainRate)) {
    const SteepestEdge away = steepest(o.other(), vertex, back);
    if (!(away.rate > kCertainRate)) {
      to_level(o.other(), o.on_other(), vec3(back), -kCertainRate);
      return o.w.levelled();
    }
    const EdgeUse& use = o.other().vertex_edges[away.at];
    const std::int32_t next = o.other().edges[use.edge].vertex[1 - use.side];
    if (next == kNone) return Step::kLost;
    return to_vertex(o.on_other(), next);
  }
  o.w.apart = o.w.proved = apart;
  o.place_above(facet, apart, tip, own_tip, n);
  return Step::kHolds;
}

// Where the line's closest point lies beyond an end of the edge, that end takes over.
HWY_INLINE bool beyond_end(const Edge& edge, double at, Side& side) {
  if (at > edge.begin && at < edge.end) return false;
  to_vertex(side, edge.vertex[at > edge.begin ? 1 : 0]);
  return true;
}

// The lines of two edges, in frame A but for own_..., and where they are nearest.
struct EdgeLines {
  HWY_INLINE explicit EdgeLines(const Walk& w)
      : first(w.a.edges[w.on_a.feature]),
        second(w.b.edges[w.on_b.feature]),
        e(load3_of_4(first.direction)),
        own_f(load3_of_4(second.direction)),
        start_a(load3_of_4(first.point)),
        own_start_b(load3_of_4(second.point)),
        f(direction_to_a(w.a_from_b, own_f)),
        start_b(point_to_a(w.a_from_b, own_start_b)),
        between(start_b - start_a),
        n(cross(e, f)),
        sine2(dot(n, n)) {}

  // s along the first and t along the second: of lines that cross. What lies between them along e
  // is taken off first, so that its rounding is over the sine, and not over the sine's square.
  HWY_INLINE void find_nearest() {
    const double cosine = dot(e, f), along_e = dot(between, e);
    t = dot(cross(between, e), n) / sine2;
    s = along_e + cosine * t;
  }
  HWY_INLINE void place_witnesses(Walk& w) const {
    w.point_a = start_a + s * e;
    w.own_b = own_start_b + t * own_f;
    w.point_b = start_b + t * f;
  }

  // m: how much farther along an edge a body may reach, by what rounding tilts the normal.
  [[nodiscard]] HWY_INLINE double reach_of_tilt(const Walk& w) const {
    return 2.0 * (w.a.bounding_radius * std::abs(dot(w.normal, e)) +
                  w.b.bounding_radius * std::abs(dot(w.normal, f)));
  }

  const Edge& first;
  const Edge& second;
  Quad e, own_f, start_a, own_start_b, f, start_b, between, n;
  double sine2, s = 0.0, t = 0.0;
};

template <bool kFirst = false>
HWY_INLINE Step edge_edge(Walk& w) {
  if (!w.a.bounded() || !w.b.bounded()) return Step::kLost;
  EdgeLines lines(w);
  if (!(lines.sine2 > kCrossingSine2)) {
    if constexpr (kFirst) {
      --w.steps;  // it is done once more, with the pair in memory
      return Step::kMoved;
    }
    return lines.sine2 <= kLevelTilt * kLevelTilt ? parallel_edges(w, lines.start_b, lines.f)
                                                  : Step::kLost;
  }
  lines.find_nearest();
  if (beyond_end(lines.first, lines.s, w.on_a) || beyond_end(lines.second, lines.t, w.on_b))
    return Step::kMoved;
  const double sine = std::sqrt(lines.sine2), limit = -kCertainRate * sine,
               apart = dot(lines.between, lines.n);
  const Quad g = with_signs(lines.n, spread(std::copysign(0.0, apart)));
  const Quad back = -direction_to_b(w.a_from_b, g);
  if (HWY_UNLIKELY(!sides_fall(lines.first, g, limit) || !sides_fall(lines.second, back, limit))) {
    rises_beside(lines.first, g, limit, w.on_a);
    rises_beside(lines.second, back, limit, w.on_b);
    return w.levelled();
  }
  w.normal = g / spread(sine);
  lines.place_witnesses(w);
  w.apart = norm(w.point_b - w.point_a);
  w.proved = std::abs(apart) / sine - lines.reach_of_tilt(w);
  return Step::kHolds;
}

HWY_INLINE Step step(Walk& w) {
  switch (w.on_a.dimension * 3 + w.on_b.dimension) {
    case 0:
      return vertex_vertex(w);
    case 1:
      return edge_vertex(Owned<true>{w});
    case 2:
      return facet_vertex(Owned<true>{w});
    case 3:
      return edge_vertex(Owned<false>{w});
    case 4:
      return edge_edge(w);
    case 5:
      return edge_facet(Owned<false>{w});
    case 6:
      return facet_vertex(Owned<false>{w});
    case 7:
      return edge_facet(Owned<true>{w});
    case 8:
      return facet_facet(w);
    default:
      return Step::kLost;
  }
}

// A vertex that is far out along `towards`; a body without vertices is one facet, or the loop's.
HWY_INLINE void start(const ConvexPolyhedron& body, Quad towards, Side& side) {
  if (body.vertices.empty()) {
    to_facet(side, 0);
  } else {
    to_vertex(side, body.start.at(vec3(towards)));
  }
}

HWY_INLINE WalkEnd conclude(Walk& w) {
  const RelativeQuads& pose = w.a_from_b;
  const Precision p =
      precision(w.a, w.b, {pose.rotation_error, pose.translation_error, pose.apart}, w.apart);
  w.slack = p.slack;
  w.on_a.point = vec3(w.point_a);
  w.on_b.point = vec3(w.own_b);
  const bool proved = w.proved > p.slack && w.apart - w.proved <= p.tight;
  return proved ? WalkEnd::kProved : WalkEnd::kSettled;
}

// From features that there are.
HWY_INLINE WalkEnd walk_on(Walk& w) {
  while (w.steps < kSteps) {
    ++w.steps;
    const Step result = step(w);
    if (result == Step::kHolds) return conclude(w);
    if (result == Step::kLost) return WalkEnd::kLost;
  }
  return WalkEnd::kLost;
}

HWY_INLINE void begin(Walk& w) {
  if (exists(w.a, w.on_a) && exists(w.b, w.on_b)) return;
  const Quad towards = point_to_a(w.a_from_b, load3(w.b.interior)) - load3(w.a.interior);
  start(w.a, towards, w.on_a);
  start(w.b, -direction_to_b(w.a_from_b, towards), w.on_b);
}

HWY_INLINE WalkEnd walk(Walk& w) {
  if (!w.a.bounded() && !w.b.bounded()) return WalkEnd::kLost;
  begin(w);
  return walk_on(w);
}

// Of a walk that is not lost. A result begins with twelve numbers; fours of them are stored one
// over the other's end, and the status last.
HWY_INLINE DistanceResult result_of(const Walk& w) {
  static_assert(offsetof(DistanceResult, normal) == 3 * sizeof(double));
  static_assert(offsetof(DistanceResult, status) == 12 * sizeof(double));
  static_assert(sizeof(DistanceResult) >= 13 * sizeof(double));
  DistanceResult r;
  double* numbers = &r.distance;
  store4(quad(w.apart, w.proved - w.slack, w.apart + w.slack, 0.0), numbers);
  store4(w.normal, numbers + 3);
  store4(w.point_a, numbers + 6);
  store4(w.point_b, numbers + 9);
  r.status = DistanceStatus::kConverged;
  r.path = DistancePath::kWalk;
  r.iterations = static_cast<std::uint16_t>(w.steps);
  return r;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
