// One transition of a pair of features, and its repetition until the pair is closest. Compiled once
// a vector width: see core/numerics/vec4-inl.hpp.
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
#include "core/feature_tracking/segments-inl.hpp"
#include "core/feature_tracking/starts-inl.hpp"
#include "core/model/edge_scan-inl.hpp"
#include "core/model/error_bounds.hpp"
#include "core/model/result_numbers.hpp"
#include "core/numerics/error_constants.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// Enough for 99.9 % of the tracked queries of the facet-ball workload. Longer ones are left to the
// active-set iteration.
inline constexpr int kMostTransitions = 40;

HWY_INLINE double size_of(const TrackedPair& pair) {
  return (pair.a.bounding_radius + pair.b.bounding_radius) + pair.a_from_b.translation_length;
}

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
inline HWY_NOINLINE bool leave_either(const ConvexBody& a, const ConvexBody& b, const Vertex& of_a,
                                      const Vertex& of_b, Side& on_a, Side& on_b, Vec4 g, Vec4 back,
                                      double limit) {
  const SteepestEdge from_a = steepest(a, of_a, g), from_b = steepest(b, of_b, back);
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
  const Vertex& of_a = pair.a.vertices[pair.on_a.feature];
  const Vertex& of_b = pair.b.vertices[pair.on_b.feature];
  pair.point_a = load3_alone(of_a.position);
  pair.local_b = load3_alone(of_b.position);
  pair.point_b = point_to_a(pair.a_from_b, pair.local_b);
  const Vec4 g = pair.point_b - pair.point_a, back = -direction_to_b(pair.a_from_b, g);
  const double distance = norm(g), limit = -kDerivativeError * distance;
  if (!all_edges_recede(pair.a, of_a, g, limit) || !all_edges_recede(pair.b, of_b, back, limit)) {
    if (HWY_UNLIKELY(distance <= kMayTouch * size_of(pair))) return Transition::kUndecided;
    return leave_either(pair.a, pair.b, of_a, of_b, pair.on_a, pair.on_b, g, back, limit)
               ? Transition::kMoved
               : pair.parallel();
  }
  pair.distance = pair.certified = distance;
  pair.normal = over(g, distance);
  return Transition::kClosest;
}

// The Voronoi region of an edge lies between the planes through its ends, across it, and on the
// outer side of its two facets. The vertex lies in it, and no edge of the vertex approaches.
template <bool kIsB>
HWY_INLINE Transition edge_vertex(const Owner<kIsB>& owner) {
  const Edge& edge = owner.body().edges[owner.side().feature];
  const Vertex& vertex = owner.other_body().vertices[owner.other_side().feature];
  EdgeAndVertex<kIsB, RelativePose4, Vec4, double> line(owner.a_from_b, load3_of_4(edge.point),
                                                        load3_of_4(edge.direction),
                                                        load3_alone(vertex.position));
  if (!(line.s > edge.begin)) return to_vertex(owner.side(), edge.vertex[0]);
  if (!(line.s < edge.end)) return to_vertex(owner.side(), edge.vertex[1]);
  line.find_separation();
  const double limit = -kDerivativeError * line.length;
  const Vec4 g = owner.direction_in_local(line.separation);
  const Vec4 back = -owner.opposite().direction_in_local(line.separation);
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
  line.place_witnesses(owner.pair, slender ? line.slender_length() : line.length);
  return Transition::kClosest;
}

// The Voronoi region of a facet is the prism over its polygon. The vertex lies in it, and no edge
// of the vertex descends towards the facet. A vertex below the plane is left to the search.
template <bool kIsB>
HWY_INLINE Transition facet_vertex(const Owner<kIsB>& owner) {
  const Facet& facet = owner.body().facets[owner.side().feature];
  const Vertex& vertex = owner.other_body().vertices[owner.other_side().feature];
  const Vec4 tip = load3_alone(vertex.position), local_tip = owner.point_from_other(tip);
  const auto plane = plane_of(owner, facet);
  const double distance = plane.height(tip, local_tip);
  if (HWY_UNLIKELY(!(distance > 0.0)) && !owner.pair.penetrating) {
    owner.pair.distance = distance;
    return Transition::kUndecided;
  }
  const std::int32_t crossed = crossed_side(owner.body(), facet, local_tip);
  if (crossed != kNone) return to_edge(owner.side(), crossed);
  const Vec4 back = -owner.opposite().direction_in_local(plane.n);
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
  owner.pair.distance = owner.pair.certified = distance;
  plane.place_witnesses(owner.pair, tip, local_tip);
  return Transition::kClosest;
}

// If the closest point of the line lies past an end of the edge, that end takes over. `at`: m along
// the edge.
HWY_INLINE bool leave_past_end(const Edge& edge, double at, Side& side) {
  if (at > edge.begin && at < edge.end) return false;
  to_vertex(side, edge.vertex[at > edge.begin ? 1 : 0]);
  return true;
}

HWY_INLINE EdgeLines<RelativePose4, Vec4, double> lines_of(const TrackedPair& pair,
                                                           const Edge& first, const Edge& second) {
  return {pair.a_from_b, load3_of_4(first.point), load3_of_4(first.direction),
          load3_of_4(second.point), load3_of_4(second.direction)};
}

// Edges that do not cross are parallel within tolerance, or rounding cannot tell.
inline HWY_NOINLINE Transition along_each_other(TrackedPair& pair) {
  const auto lines =
      lines_of(pair, pair.a.edges[pair.on_a.feature], pair.b.edges[pair.on_b.feature]);
  return lines.sine2 <= kParallelTilt * kParallelTilt ? parallel_edges(pair, lines.start_b, lines.f)
                                                      : Transition::kUndecided;
}
inline HWY_NOINLINE Transition between_facets(TrackedPair& pair) {
  return facet_facet<Tracking::kFurther>(pair);
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
  // Then g is the direction along which no facet approaches by more than rounding.
  if (touching && std::max(steepest_of(first, -g), steepest_of(second, -back)) <= -limit) {
    g = -g;
    back = -back;
  }
  // If facets of both approach, the one that approaches faster takes over.
  const double of_a = steepest_of(first, g), of_b = steepest_of(second, back);
  if (!(of_b > -limit) || of_a >= of_b) to_approaching_facet(first, g, limit, on_a);
  if (!(of_a > -limit) || of_b > of_a) to_approaching_facet(second, back, limit, on_b);
}

// Crossing edges are closest if the feet of their common perpendicular lie within both, and all
// four facets beside them recede along it. `kMode`: see transition().
template <Tracking kMode>
HWY_INLINE Transition edge_edge(TrackedPair& pair) {
  if (kMode != Tracking::kFirstOfPlain && (!pair.a.bounded() || !pair.b.bounded())) {
    return Transition::kUndecided;
  }
  const Edge& first = pair.a.edges[pair.on_a.feature];
  const Edge& second = pair.b.edges[pair.on_b.feature];
  auto lines = lines_of(pair, first, second);
  if (HWY_UNLIKELY(!(lines.sine2 > kCrossingSine2))) {
    if constexpr (kMode == Tracking::kFurther) return along_each_other(pair);
    return lines.sine2 <= kParallelTilt * kParallelTilt
               ? parallel_edges(pair, lines.start_b, lines.f)
               : Transition::kUndecided;
  }
  lines.find_nearest();
  if (leave_past_end(first, lines.s, pair.on_a) || leave_past_end(second, lines.t, pair.on_b)) {
    return Transition::kMoved;
  }
  const double sine = std::sqrt(lines.sine2), limit = -kDerivativeError * sine,
               along_n = dot(lines.between, lines.n);  // the distance times the sine
  // The normal across both lines, from A to B.
  const Vec4 g = with_signs(lines.n, spread(std::copysign(0.0, along_n)));
  const Vec4 back = -direction_to_b(pair.a_from_b, g);
  if (HWY_UNLIKELY(!both_facets_recede(first, g, limit) ||
                   !both_facets_recede(second, back, limit))) {
    const bool may_touch = std::abs(along_n) <= kMayTouch * size_of(pair);
    if (may_touch && !pair.penetrating) return Transition::kUndecided;
    leave_edges(first, second, pair.on_a, pair.on_b, g, back, limit, may_touch);
    return pair.parallel();
  }
  pair.normal = over(g, sine);
  lines.place_witnesses(pair);
  pair.distance = norm(pair.point_b - pair.point_a);
  pair.certified =
      std::abs(along_n) / sine -
      lines.tilt_error_of_edges(pair.normal, pair.a.bounding_radius, pair.b.bounding_radius);
  return Transition::kClosest;
}

// The transition of straight features: see has_straight_features().
template <FeaturePair kPair, Tracking kMode>
HWY_INLINE Transition transition_of(TrackedPair& pair) {
  if constexpr (kPair == FeaturePair::kVertexVertex) return vertex_vertex(pair);
  if constexpr (kPair == FeaturePair::kVertexEdge) return edge_vertex(Owner<true>(pair));
  if constexpr (kPair == FeaturePair::kVertexFacet) return facet_vertex(Owner<true>(pair));
  if constexpr (kPair == FeaturePair::kEdgeVertex) return edge_vertex(Owner<false>(pair));
  if constexpr (kPair == FeaturePair::kEdgeEdge) return edge_edge<kMode>(pair);
  if constexpr (kPair == FeaturePair::kFacetVertex) return facet_vertex(Owner<false>(pair));
  if constexpr (kPair == FeaturePair::kFacetFacet) return facet_facet<kMode>(pair);
}

// For disjoint bodies, this is the only branch on the pair of features.
template <Tracking kMode>
HWY_INLINE Transition transition(TrackedPair& pair) {
  assert(exists(pair.a, pair.on_a) || pair.on_a.kind == FeatureKind::kUnknown);
  assert(exists(pair.b, pair.on_b) || pair.on_b.kind == FeatureKind::kUnknown);
  switch (pair.features()) {
    case FeaturePair::kVertexVertex:
      return transition_of<FeaturePair::kVertexVertex, kMode>(pair);
    case FeaturePair::kVertexEdge:
      return transition_of<FeaturePair::kVertexEdge, kMode>(pair);
    case FeaturePair::kVertexFacet:
      return transition_of<FeaturePair::kVertexFacet, kMode>(pair);
    case FeaturePair::kEdgeVertex:
      return transition_of<FeaturePair::kEdgeVertex, kMode>(pair);
    case FeaturePair::kEdgeEdge:
      return transition_of<FeaturePair::kEdgeEdge, kMode>(pair);
    default:
      break;
  }
  // has_straight_features() admits one more pair to a first transition.
  if constexpr (kMode != Tracking::kFurther) {
    return transition_of<FeaturePair::kFacetVertex, kMode>(pair);
  }
  switch (pair.features()) {
    case FeaturePair::kEdgeFacet:
      return edge_facet(Owner<false>(pair));
    case FeaturePair::kFacetVertex:
      return facet_vertex(Owner<false>(pair));
    case FeaturePair::kFacetEdge:
      return edge_facet(Owner<true>(pair));
    case FeaturePair::kFacetFacet:
      return between_facets(pair);
    default:
      return Transition::kUndecided;
  }
}

// Below this distance, m, squares of coordinates underflow: a normal then is not of unit length,
// and the error bound, which is larger, holds alone.
inline constexpr double kLeastWithNormal = 1e-150;

// The certificate of the closest features. Their distance bounds that of the bodies from above, and
// `certified` bounds it from below, both up to the error bound of Precision.
template <bool kBounded = false>
HWY_INLINE TrackingEnd certify(TrackedPair& pair) {
  const RelativePose4& pose = pair.a_from_b;
  const Precision p = precision<kBounded>(
      pair.a, pair.b, {pose.rotation_error, pose.translation_error, pose.translation_length},
      pair.distance);
  assert(pair.distance < kLeastWithNormal ||
         (is_unit_or_unknown(vec3(pair.normal)) && !(pair.certified > pair.distance + p.size)));
  pair.error_bound = p.error_bound;
  pair.on_a.point = vec3(pair.point_a);
  pair.on_b.point = vec3(pair.local_b);
  const bool certified =
      pair.certified > p.error_bound && pair.distance - pair.certified <= p.gap_tolerance;
  return certified ? TrackingEnd::kCertified : TrackingEnd::kUncertified;
}

// Makes transitions from existing features until they are closest.
HWY_INLINE TrackingEnd continue_tracking(TrackedPair& pair) {
  while (pair.transitions < kMostTransitions) {
    ++pair.transitions;
    const Transition result = transition<Tracking::kFurther>(pair);
    if (result == Transition::kClosest) return certify(pair);
    if (result == Transition::kUndecided) return TrackingEnd::kUndecided;
  }
  return TrackingEnd::kExhausted;
}

HWY_INLINE TrackingEnd track(TrackedPair& pair) {
  if (!pair.a.bounded() && !pair.b.bounded()) return TrackingEnd::kUndecided;
  begin(pair);
  if (pair.starts_in_contact) return TrackingEnd::kUndecided;
  return continue_tracking(pair);
}

// The result of a tracking that is not undecided. Each store of four numbers writes one too many,
// which the next store overwrites. The status overwrites the last one.
HWY_INLINE DistanceResult result_of(const TrackedPair& pair) {
  DistanceResult r;
  store4(
      vec4(pair.distance, pair.certified - pair.error_bound, pair.distance + pair.error_bound, 0.0),
      number_at(r, 0));
  store4(pair.normal, number_at(r, 3));
  store4(pair.point_a, number_at(r, 6));
  store4(pair.point_b, number_at(r, 9));
  r.status = DistanceStatus::kConverged;
  r.path = DistancePath::kFeatureTracking;
  r.iterations = static_cast<std::uint16_t>(pair.transitions);
  return r;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
