// One transition of a pair of features, and its repetition until the pair is closest. Compiled once
// per vector width: see core/numerics/vec4-inl.hpp.
#if defined(CLEARANCE_CORE_TRANSITIONS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_TRANSITIONS
#undef CLEARANCE_CORE_TRANSITIONS
#else
#define CLEARANCE_CORE_TRANSITIONS
#endif

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/feature_tracking/parallel_transitions-inl.hpp"
#include "core/feature_tracking/starts-inl.hpp"
#include "core/model/edge_scan-inl.hpp"
#include "core/numerics/error_constants.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// Enough for 99.9 % of the tracked queries of the facet-ball workload. Longer ones are left to the
// active-set iteration.
inline constexpr int kMostTransitions = 40;

// Leaves a vertex along its steepest edge: onto the edge, or past it to its far end.
inline Transition leave_vertex(const ConvexBody& body, Side& side, const SteepestEdge& steepest) {
  const EdgeUse& use = body.vertex_edges[steepest.at];
  const Edge& edge = body.edges[use.edge];
  if (steepest.derivative >= edge.end && edge.vertex[1 - use.side] != kNone) {
    return to_vertex(side, edge.vertex[1 - use.side]);
  }
  return to_edge(side, use.edge);
}

// Leaves the vertex whose edge approaches faster. False: no edge approaches by more than rounding,
// and both sides move to parallel features.
inline HWY_NOINLINE bool leave_either(const ConvexBody& a, const ConvexBody& b,
                                      const Vertex& vertex_a, const Vertex& vertex_b, Side& on_a,
                                      Side& on_b, Vec4 g, Vec4 back, double limit) {
  const SteepestEdge from_a = steepest(a, vertex_a, g), from_b = steepest(b, vertex_b, back);
  if (from_a.derivative > -limit && from_a.derivative >= from_b.derivative) {
    return leave_vertex(a, on_a, from_a) == Transition::kMoved;
  }
  if (from_b.derivative > -limit) return leave_vertex(b, on_b, from_b) == Transition::kMoved;
  to_parallel(a, on_a, vec3(g), limit);
  to_parallel(b, on_b, vec3(back), limit);
  return false;
}

// Two vertices are closest if each lies in the Voronoi region of the other: no edge that leaves
// either of them approaches the other.
HWY_INLINE Transition vertex_vertex(TrackedPair& pair) {
  const Vertex& vertex_a = pair.a.vertices[pair.on_a.feature];
  const Vertex& vertex_b = pair.b.vertices[pair.on_b.feature];
  pair.found.a_A = load3_masked(vertex_a.position);
  pair.found.b_B = load3_masked(vertex_b.position);
  pair.found.b_A = point_to_a(pair.a_from_b, pair.found.b_B);
  const Vec4 g = pair.found.b_A - pair.found.a_A, back = -direction_to_b(pair.a_from_b, g);
  const double distance = norm(g), limit = -kDerivativeError * distance;
  if (!all_edges_recede(pair.a, vertex_a, g, limit) ||
      !all_edges_recede(pair.b, vertex_b, back, limit)) {
    if (HWY_UNLIKELY(distance <= kMayTouch * size_of(pair))) return Transition::kUndecided;
    return leave_either(pair.a, pair.b, vertex_a, vertex_b, pair.on_a, pair.on_b, g, back, limit)
               ? Transition::kMoved
               : pair.parallel();
  }
  pair.found.distance = pair.found.certified = distance;
  pair.found.n_A = over(g, distance);
  return Transition::kClosest;
}

// The Voronoi region of an edge lies between the planes through its ends, across it, and on the
// outer side of its two facets. The vertex lies in it, and no edge of the vertex approaches.
template <bool kIsB>
HWY_INLINE Transition edge_vertex(const Owner<kIsB>& owner) {
  const Edge& edge = owner.body().edges[owner.side().feature];
  const Vertex& vertex = owner.other_body().vertices[owner.other_side().feature];
  EdgeAndVertex<kIsB> line(owner.a_from_b, load3_padded(edge.point), load3_padded(edge.direction),
                           load3_masked(vertex.position));
  if (!(line.s > edge.begin)) return to_vertex(owner.side(), edge.vertex[0]);
  if (!(line.s < edge.end)) return to_vertex(owner.side(), edge.vertex[1]);
  line.find_separation();
  const double limit = -kDerivativeError * line.length;
  const Vec4 g = owner.direction_A_to_L(line.separation_A);
  const Vec4 back = -owner.opposite().direction_A_to_L(line.separation_A);
  if (!both_facets_recede(edge, g, limit)) {
    if (HWY_UNLIKELY(line.length <= kMayTouch * size_of(owner.pair))) return Transition::kUndecided;
    to_approaching_facet(edge, g, limit, owner.side());
    const Vec2 derivatives = facet_derivatives(edge, g);
    if (std::max(derivatives[0], derivatives[1]) > -limit) return Transition::kMoved;
    to_parallel(owner.other_body(), owner.other_side(), vec3(back), limit);
    return owner.pair.parallel();
  }
  if (!all_edges_recede(owner.other_body(), vertex, back, limit)) {
    const SteepestEdge away = steepest(owner.other_body(), vertex, back);
    if (!(away.derivative > -limit)) {
      to_parallel(owner.other_body(), owner.other_side(), vec3(back), limit);
      return owner.pair.parallel();
    }
    return to_edge(owner.other_side(), owner.other_body().vertex_edges[away.at].edge);
  }
  const bool slender = HWY_UNLIKELY(line.length < kSlender * std::abs(line.s));
  line.place_witnesses(owner.pair.found, slender ? line.slender_length() : line.length);
  return Transition::kClosest;
}

// The Voronoi region of a facet is the prism over its polygon. The vertex lies in it, and no edge
// of the vertex descends towards the facet. A vertex below the plane is left to the search.
template <bool kIsB>
HWY_INLINE Transition facet_vertex(const Owner<kIsB>& owner) {
  const Facet& facet = owner.body().facets[owner.side().feature];
  const Vertex& vertex = owner.other_body().vertices[owner.other_side().feature];
  const Vec4 tip = load3_masked(vertex.position), local_tip = owner.point_O_to_L(tip);
  const auto plane = plane_of(owner, facet);
  const double distance = plane.height(tip, local_tip);
  if (HWY_UNLIKELY(!(distance > 0.0)) && !owner.pair.penetrating) {
    owner.pair.found.distance = distance;
    return Transition::kUndecided;
  }
  const std::int32_t crossed = crossed_side(owner.body(), facet, local_tip);
  if (crossed != kNone) return to_edge(owner.side(), crossed);
  const Vec4 back = -owner.opposite().direction_A_to_L(plane.n_A);
  if (!all_edges_recede(owner.other_body(), vertex, back, -kDerivativeError)) {
    const SteepestEdge away = steepest(owner.other_body(), vertex, back);
    if (!(away.derivative > kDerivativeError)) {
      to_parallel(owner.other_body(), owner.other_side(), vec3(back), -kDerivativeError);
      return owner.pair.parallel();
    }
    const EdgeUse& use = owner.other_body().vertex_edges[away.at];
    const Edge& down = owner.other_body().edges[use.edge];
    const std::int32_t next = down.vertex[1 - use.side];
    if (next == kNone) return Transition::kUndecided;
    // An edge that leads below the plane leaves the prism before, or the bodies overlap.
    if (!(distance / away.derivative > down.end)) {
      return to_edge(owner.other_side(), use.edge);
    }
    return to_vertex(owner.other_side(), next);
  }
  owner.pair.found.distance = owner.pair.found.certified = distance;
  plane.place_witnesses(owner.pair.found, tip, local_tip);
  return Transition::kClosest;
}

// If the closest point of the line lies past an end of the edge, that end takes over. `at`: m along
// the edge.
HWY_INLINE bool leave_past_end(const Edge& edge, double at, Side& side) {
  if (at > edge.begin && at < edge.end) return false;
  to_vertex(side, edge.vertex[at > edge.begin ? 1 : 0]);
  return true;
}

HWY_INLINE EdgeLines lines_of(const TrackedPair& pair, const Edge& first, const Edge& second) {
  return {pair.a_from_b, load3_padded(first.point), load3_padded(first.direction),
          load3_padded(second.point), load3_padded(second.direction)};
}

// For crossing edges beside which a facet approaches along g, the direction from A's to B's, and
// along `back` in frame B. `touching`: of bodies that touched, the lines are so near that rounding
// may have reversed g.
inline HWY_NOINLINE void leave_edges(const Edge& first, const Edge& second, Side& on_a, Side& on_b,
                                     Vec4 g, Vec4 back, double limit, bool touching) {
  const auto steepest_of = [](const Edge& edge, Vec4 along) HWY_ATTR {
    const Vec2 both = facet_derivatives(edge, along);
    return edge.facet[0] == kNone ? -kInfinity : std::max(both[0], both[1]);
  };
  // Now g is the direction along which no facet approaches by more than rounding.
  if (touching && std::max(steepest_of(first, -g), steepest_of(second, -back)) <= -limit) {
    g = -g;
    back = -back;
  }
  // If facets of both approach, the one that approaches faster takes over.
  const double slope_a = steepest_of(first, g), slope_b = steepest_of(second, back);
  if (!(slope_b > -limit) || slope_a >= slope_b) to_approaching_facet(first, g, limit, on_a);
  if (!(slope_a > -limit) || slope_b > slope_a) to_approaching_facet(second, back, limit, on_b);
}

// Crossing edges are closest if the feet of their common perpendicular lie within both, and all
// four facets beside them recede along it.
HWY_INLINE Transition edge_edge(TrackedPair& pair) {
  if (!pair.a.bounded() || !pair.b.bounded()) return Transition::kUndecided;
  const Edge& first = pair.a.edges[pair.on_a.feature];
  const Edge& second = pair.b.edges[pair.on_b.feature];
  auto lines = lines_of(pair, first, second);
  if (HWY_UNLIKELY(!(lines.sine2 > kCrossingSine2))) {
    return lines.sine2 <= kParallelTilt * kParallelTilt
               ? parallel_edges(pair, lines.start_b_A, lines.f_A)
               : Transition::kUndecided;
  }
  lines.find_nearest();
  if (leave_past_end(first, lines.s, pair.on_a) || leave_past_end(second, lines.t, pair.on_b)) {
    return Transition::kMoved;
  }
  const double sine = std::sqrt(lines.sine2), limit = -kDerivativeError * sine,
               along_n = dot(lines.between_A, lines.n_A);  // the distance times the sine
  // The normal across both lines, from A to B.
  const Vec4 g = with_signs(lines.n_A, spread(std::copysign(0.0, along_n)));
  const Vec4 back = -direction_to_b(pair.a_from_b, g);
  if (HWY_UNLIKELY(!both_facets_recede(first, g, limit) ||
                   !both_facets_recede(second, back, limit))) {
    const bool may_touch = std::abs(along_n) <= kMayTouch * size_of(pair);
    if (may_touch && !pair.penetrating) return Transition::kUndecided;
    leave_edges(first, second, pair.on_a, pair.on_b, g, back, limit, may_touch);
    return pair.parallel();
  }
  pair.found.n_A = over(g, sine);
  lines.place_witnesses(pair.found);
  pair.found.distance = norm(pair.found.b_A - pair.found.a_A);
  pair.found.certified =
      std::abs(along_n) / sine -
      lines.tilt_error_of_edges(pair.found.n_A, pair.a.bounding_radius, pair.b.bounding_radius);
  return Transition::kClosest;
}

// The transitions that are straight-line code. They leave an edge and a facet undecided.
HWY_INLINE Transition straight_transition(TrackedPair& pair) {
  switch (pair.features()) {
    case FeaturePair::kVertexVertex:
      return vertex_vertex(pair);
    case FeaturePair::kVertexEdge:
      return edge_vertex(Owner<true>(pair));
    case FeaturePair::kVertexFacet:
      return facet_vertex(Owner<true>(pair));
    case FeaturePair::kEdgeVertex:
      return edge_vertex(Owner<false>(pair));
    case FeaturePair::kEdgeEdge:
      return edge_edge(pair);
    case FeaturePair::kFacetVertex:
      return facet_vertex(Owner<false>(pair));
    case FeaturePair::kFacetFacet:
      return facet_facet(pair);
    default:
      return Transition::kUndecided;
  }
}

HWY_INLINE Transition transition(TrackedPair& pair) {
  if (pair.features() == FeaturePair::kEdgeFacet) return edge_facet(Owner<false>(pair));
  if (pair.features() == FeaturePair::kFacetEdge) return edge_facet(Owner<true>(pair));
  return straight_transition(pair);
}

// Are the features of the last query still the closest? Most queries of a moving scene are: so
// nothing here gets the addresses of the pose and of the pair, and both stay in registers.
// Otherwise the state has the features that take over, and `made` counts the transition to them.
HWY_INLINE bool still_closest(const Query4& q, TransitionsMade& made, Answer& answer) {
  assert(has_features(q));
  TrackedPair pair(q);
  pair.made.all = 1;
  const Transition first = straight_transition(pair);
  if (HWY_LIKELY(first == Transition::kClosest && certify(pair) == TrackingEnd::kCertified)) {
    write(pair, answer);
    return true;
  }
  if (first == Transition::kMoved) made = pair.made;
  return false;
}

// Makes transitions until the features are closest.
HWY_INLINE TrackingEnd move_to_closest(TrackedPair& pair) {
  if (!pair.a.bounded() && !pair.b.bounded()) return TrackingEnd::kUndecided;
  // to_vertex() may have left a side without a feature.
  assert(exists(pair.a, pair.on_a) || pair.on_a.kind == FeatureKind::kUnknown);
  assert(exists(pair.b, pair.on_b) || pair.on_b.kind == FeatureKind::kUnknown);
  while (pair.made.all < kMostTransitions) {
    ++pair.made.all;
    const Transition result = transition(pair);
    if (HWY_LIKELY(result == Transition::kClosest)) return certify(pair);
    if (result == Transition::kUndecided) return TrackingEnd::kUndecided;
  }
  return TrackingEnd::kExhausted;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
