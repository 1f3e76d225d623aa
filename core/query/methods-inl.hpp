// The methods of a query: those that answer nearly all queries first. Compiled once a vector width:
// see core/numerics/vec4-inl.hpp.
#if defined(CLEARANCE_CORE_QUERY_METHODS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_QUERY_METHODS
#undef CLEARANCE_CORE_QUERY_METHODS
#else
#define CLEARANCE_CORE_QUERY_METHODS
#endif

#include <cassert>

#include "core/feature_tracking/penetrating_transitions-inl.hpp"
#include "core/model/radii.hpp"
#include "core/model/result_invariants.hpp"
#include "core/query/search.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

DistanceResult from_penetration(const ConvexBody& a, const ConvexBody& b,
                                const RelativePose4& a_from_b, TrackingState& state);
DistanceResult from_contact(const ConvexBody& a, const ConvexBody& b, const RelativePose4& a_from_b,
                            TrackingState& state, bool depth);

// B's place in A's frame, by two poses or by a relative pose.
struct WorldPoses {
  const Pose &of_a, &of_b;
  [[nodiscard]] HWY_INLINE RelativePose4 relative() const { return relative_pose4(of_a, of_b); }
};
struct GivenPose {
  const RelativePose& a_from_b;
  [[nodiscard]] HWY_INLINE RelativePose4 relative() const { return good_pose4_of(a_from_b); }
};

template <class Place>
DistanceResult from_any_state(const ConvexBody& a, const ConvexBody& b, Place place,
                              TrackingState& state, bool depth);

HWY_INLINE DistanceResult rounded_result_of(const TrackedPair& pair) {
  DistanceResult result = result_of(pair);
  add_radii(result, pair.a, pair.b);
  assert(keeps_promises(result));
  return result;
}

// Are the features where tracking ended worth a test for contact? Far below a facet's plane, as a
// part of the size, they seldom certify a depth.
inline constexpr double kShallow = 0x1p-5;
HWY_INLINE bool may_touch(const TrackedPair& pair, TrackingEnd end) {
  if (end == TrackingEnd::kExhausted) return false;
  return !(pair.distance < -kShallow * size_of(pair)) || are_facets_of_boxes(pair);
}

// The TrackedPair is a new one, so that the one of from_features() can stay in registers.
inline HWY_NOINLINE DistanceResult after_first_transition(const ConvexBody& a, const ConvexBody& b,
                                                          const RelativePose4& a_from_b,
                                                          TrackingState& state,
                                                          TransitionsMade start, Transition first) {
  // The pair that the first transition has left undecided is examined once more, as it is for a
  // pair of a batch.
  if (first != Transition::kMoved) --start.transitions;
  TrackedPair pair(a, b, a_from_b, state, start);
  pair.distance = 0.0;
  const TrackingEnd end =
      first == Transition::kClosest ? TrackingEnd::kUncertified : continue_tracking(pair);
  if (end == TrackingEnd::kCertified) return rounded_result_of(pair);
  if (may_touch(pair, end)) return from_contact(a, b, a_from_b, state, true);
  return search_distance(a, b, pose_of(a_from_b), state, true);
}

// Most queries of a moving scene end here, at the features of the last query. The pose and the pair
// stay in registers, because nothing else gets their addresses. `kMove`: the first transition.
template <Transition (*kMove)(TrackedPair&), bool kBounded>
HWY_INLINE DistanceResult from_features(const ConvexBody& a, const ConvexBody& b,
                                        const RelativePose4& a_from_b, TrackingState& state) {
  TrackedPair pair(a, b, a_from_b, state);
  ++pair.transitions;
  const Transition first = kMove(pair);
  if (HWY_LIKELY(first == Transition::kClosest &&
                 certify<kBounded>(pair) == TrackingEnd::kCertified)) {
    return rounded_result_of(pair);
  }
  const RelativePose4 in_memory = a_from_b;
  return after_first_transition(a, b, in_memory, state,
                                {pair.transitions, pair.parallel_transitions}, first);
}

// Two plain bodies, or a point and a plain one.
template <FeaturePair kPair, class Place>
HWY_INLINE DistanceResult from_pair(const ConvexBody& a, const ConvexBody& b, Place place,
                                    TrackingState& state) {
  if (HWY_UNLIKELY(!has_feature(a, kind_on_a(kPair), state.a) ||
                   !has_feature(b, kind_on_b(kPair), state.b))) {
    return from_any_state(a, b, place, state, true);
  }
  return from_features<transition_of<kPair, Tracking::kFirstOfPlain>, true>(a, b, place.relative(),
                                                                            state);
}

// Two points need no features: their states are not read.
HWY_INLINE bool are_disjoint_points(TrackedPair& pair) {
  ++pair.transitions;
  const Vec4 g = meet_points(pair);
  measure_points(pair, g, norm(g));
  return HWY_LIKELY(certify<true>(pair) == TrackingEnd::kCertified);
}
template <class Place>
HWY_NOINLINE DistanceResult between_any_points(const ConvexBody& a, const ConvexBody& b,
                                               Place place, TrackingState& state, bool depth) {
  const RelativePose4 a_from_b = place.relative();
  TrackedPair pair(a, b, a_from_b, state);
  place_point_of_b(pair);
  if (are_disjoint_points(pair)) return rounded_result_of(pair);
  return search_distance(a, b, pose_of(a_from_b), state, depth);
}
HWY_INLINE DistanceResult between_points(const ConvexBody& a, const ConvexBody& b, GivenPose place,
                                         TrackingState& state) {
  return between_any_points(a, b, place, state, true);
}
// A sphere is mostly around the origin of its frame, and then its orientation does not matter. The
// bits are the same.
HWY_INLINE DistanceResult between_points(const ConvexBody& a, const ConvexBody& b, WorldPoses place,
                                         TrackingState& state) {
  RelativePose4 a_from_b;
  if (HWY_LIKELY(b.bounding_radius == 0.0 && set_place(place.of_a, place.of_b, a_from_b))) {
    TrackedPair pair(a, b, a_from_b, state);
    pair.local_b = spread(0.0);
    pair.point_b = a_from_b.translation;
    ++pair.transitions;
    const Vec4 g = meet_points(pair);
    measure_points(pair, g,
                   HWY_LIKELY(a.bounding_radius == 0.0) ? a_from_b.translation_length : norm(g));
    if (HWY_LIKELY(certify<true>(pair) == TrackingEnd::kCertified)) return rounded_result_of(pair);
  }
  return between_any_points(a, b, place, state, true);
}

// Two segments, or a point and a segment, without features: see segments-inl.hpp.
template <class Place>
HWY_NOINLINE DistanceResult between_segments(const ConvexBody& a, const ConvexBody& b, Place place,
                                             TrackingState& state) {
  const RelativePose4 a_from_b = place.relative();
  start_at_segments(a, b, a_from_b, state);
  return from_features<transition<Tracking::kFirstOfPlain>, true>(a, b, a_from_b, state);
}

HWY_INLINE DistanceResult curved_distance_of(const ConvexBody& a, const ConvexBody& b,
                                             WorldPoses place, TrackingState& state,
                                             bool /*depth*/) {
  return curved_pair_distance(a, b, place.of_a, place.of_b, state);
}
HWY_INLINE DistanceResult curved_distance_of(const ConvexBody& a, const ConvexBody& b,
                                             GivenPose place, TrackingState& state, bool depth) {
  if (!is_good(place.a_from_b)) return of_bad_pose(state);
  return curved_pair_distance(a, b, place.a_from_b, state, depth);
}

// For states without features or with parallel ones, and for penetrating bodies.
template <class Place>
HWY_NOINLINE DistanceResult tracked_or_searched(const ConvexBody& a, const ConvexBody& b,
                                                Place place, TrackingState& state,
                                                TransitionsMade start, bool depth) {
  const RelativePose4 a_from_b = place.relative();
  if (state.a.penetrating && depth) return from_penetration(a, b, a_from_b, state);
  TrackedPair pair(a, b, a_from_b, state, start);
  pair.distance = 0.0;
  const TrackingEnd end = track(pair);
  if (end == TrackingEnd::kCertified) return rounded_result_of(pair);
  if (may_touch(pair, end)) return from_contact(a, b, a_from_b, state, depth);
  return search_distance(a, b, pose_of(a_from_b), state, depth);
}

// The features of disjoint bodies, at least one of them unbounded.
template <class Place>
HWY_NOINLINE DistanceResult from_straight_features(const ConvexBody& a, const ConvexBody& b,
                                                   Place place, TrackingState& state) {
  return from_features<transition<Tracking::kFirst>, false>(a, b, place.relative(), state);
}
template <class Place>
HWY_NOINLINE DistanceResult from_facets(const ConvexBody& a, const ConvexBody& b, Place place,
                                        TrackingState& state) {
  return from_features<facet_facet<Tracking::kFirst>, false>(a, b, place.relative(), state);
}

// A quick test before the table of closed forms: false if both bodies are bounded and one of them
// has facets.
HWY_INLINE bool may_have_closed_form(const ConvexBody& a, const ConvexBody& b) {
  return query_class(a, b) >= kTwoPoints || (a.features[2] | b.features[2]) == 0;
}

// Any bodies and any state. Each method makes the relative pose, as far as it needs it.
template <class Place>
HWY_INLINE DistanceResult from_any_bodies(const ConvexBody& a, const ConvexBody& b, Place place,
                                          TrackingState& state, bool depth) {
  if (HWY_UNLIKELY(may_have_closed_form(a, b))) {
    if (a.is_curved() || b.is_curved()) return curved_distance_of(a, b, place, state, depth);
    if (query_class(a, b) == kTwoPoints) return between_any_points(a, b, place, state, depth);
    if (depth && are_segments_without_features(a, b, state)) {
      return between_segments(a, b, place, state);
    }
    if (depth && query_class(a, b) >= kTwoPoints && can_be_tracked(a, b, state)) {
      if (has_straight_features(state)) return from_straight_features(a, b, place, state);
      if (has_facets(state)) return from_facets(a, b, place, state);
    }
  }
  return tracked_or_searched(a, b, place, state, {}, depth);
}
template <class Place>
HWY_NOINLINE DistanceResult from_any_state(const ConvexBody& a, const ConvexBody& b, Place place,
                                           TrackingState& state, bool depth) {
  return from_any_bodies(a, b, place, state, depth);
}

HWY_INLINE DistanceResult penetrating_result_of(const TrackedPair& pair) {
  DistanceResult result = penetration_result_of(pair);
  add_radii(result, pair.a, pair.b);
  assert(keeps_promises(result));
  return result;
}

// The entry for two bounded bodies that touched or penetrated each other at two facets in the last
// query, as a body on a floor does. The pose and the pair stay in registers, as in from_features().
template <class Place>
HWY_INLINE DistanceResult from_touching_facets(const ConvexBody& a, const ConvexBody& b,
                                               Place place, TrackingState& state) {
  if (HWY_UNLIKELY(!has_feature(a, FeatureKind::kFacet, state.a) ||
                   !has_feature(b, FeatureKind::kFacet, state.b))) {
    return from_any_state(a, b, place, state, true);
  }
  const RelativePose4 a_from_b = place.relative();
  const std::int32_t on_a = state.a.feature, on_b = state.b.feature;
  TrackedPair pair(a, b, a_from_b, state);
  pair.penetrating = true;
  pair.inradius = pair.depth_error = 0.0;
  ++pair.transitions;
  if (HWY_LIKELY(facet_facet<Tracking::kFirstOfPlain>(pair) == Transition::kClosest &&
                 certify_penetration<true>(pair))) {
    return penetrating_result_of(pair);
  }
  to_facet(state.a, on_a);
  to_facet(state.b, on_b);
  const RelativePose4 in_memory = a_from_b;
  return from_penetration(a, b, in_memory, state);
}

// Level boxes slide from one pair of features to another, and the last one may certify nothing.
HWY_NOINLINE bool restart_boxes(TrackedPair& pair) {
  return shared_axes(squares_of(pair.a_from_b.rotation)) != 0 && start_boxes(pair) &&
         track_penetrating_features(pair);
}

// The bodies touched or penetrated each other in the last query.
HWY_NOINLINE DistanceResult from_penetration(const ConvexBody& a, const ConvexBody& b,
                                             const RelativePose4& a_from_b, TrackingState& state) {
  TrackedPair pair(a, b, a_from_b, state);
  if (track_penetrating_features(pair) || restart_boxes(pair)) return penetrating_result_of(pair);
  return penetrating_distance(a, b, pose_of(a_from_b), state);
}

// Feature tracking has left a query open. The bodies may touch, or overlap by little, at the
// features where it ended. If no depths are asked for, only disjoint bodies are answered.
HWY_NOINLINE DistanceResult from_contact(const ConvexBody& a, const ConvexBody& b,
                                         const RelativePose4& a_from_b, TrackingState& state,
                                         bool depth) {
  TrackedPair pair(a, b, a_from_b, state);
  if (track_penetrating_features(pair) && (depth || !pair.on_a.penetrating)) {
    return penetrating_result_of(pair);
  }
  return search_distance(a, b, pose_of(a_from_b), state, depth);
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
