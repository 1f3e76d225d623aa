// distance(), from top to bottom: the state of a pair says which method goes first.
//
//   straight features,
//   or two facets ─────► one transition ─► certified ─────────────────────────────► result
//                             └─ moved ─┐
//   other features, or none ────────────┴─► feature tracking ─► certified ────────► result
//                                                 └─ left open ─► penetrating features
//   touched or penetrated in the last query ► penetrating features ─► certified ───► result
//                                                 └─ left open ─► search.hpp
//   a curved body ─────────────────────────► core/curved
//
// Everything in HWY_NAMESPACE is compiled once a vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/query/distance.cpp"
#include "core/numerics/simd_targets.hpp"
// The include above must come first.
#include <cassert>

#include "core/distance.hpp"
#include "core/feature_tracking/penetrating_transitions-inl.hpp"
#include "core/model/radii.hpp"
#include "core/model/result_invariants.hpp"
#include "core/query/search.hpp"
#include "core/query/tracked_query.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// Two points, or unbounded bodies.
DistanceResult from_rare_classes(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                                 const Pose& world_from_b, TrackingState& state);
DistanceResult relative_from_rare_classes(const ConvexBody& a, const ConvexBody& b,
                                          const RelativePose& a_from_b, TrackingState& state);
// The two entries by poses: has_straight_features(state) decides which one. Either accepts any
// state.
DistanceResult from_straight_features(const ConvexBody& a, const ConvexBody& b,
                                      const Pose& world_from_a, const Pose& world_from_b,
                                      TrackingState& state);
DistanceResult from_facets(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                           const Pose& world_from_b, TrackingState& state);
DistanceResult from_any_state(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                              const Pose& world_from_b, TrackingState& state);
// The same three by a relative pose. The first two of them compute the depth as well.
DistanceResult relative_from_straight_features(const ConvexBody& a, const ConvexBody& b,
                                               const RelativePose& a_from_b, TrackingState& state);
DistanceResult relative_from_facets(const ConvexBody& a, const ConvexBody& b,
                                    const RelativePose& a_from_b, TrackingState& state);
DistanceResult relative_from_any_state(const ConvexBody& a, const ConvexBody& b,
                                       const RelativePose& a_from_b, TrackingState& state,
                                       bool depth);
// For a batch, which has made transitions already.
DistanceResult after_transitions(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                                 const Pose& world_from_b, TrackingState& state,
                                 TransitionsMade start);

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <atomic>

namespace clearance {

HWY_EXPORT(from_straight_features);
HWY_EXPORT(from_facets);
HWY_EXPORT(from_any_state);
HWY_EXPORT(relative_from_straight_features);
HWY_EXPORT(relative_from_facets);
HWY_EXPORT(relative_from_any_state);
HWY_EXPORT(after_transitions);

#if (HWY_TARGETS & (HWY_TARGETS - 1)) == 0  // one vector width only

DistanceResult distance(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                        const Pose& world_from_b, TrackingState& state) noexcept {
  if (has_straight_features(state)) {
    return HWY_STATIC_DISPATCH(from_straight_features)(a, b, world_from_a, world_from_b, state);
  }
  return has_facets(state)
             ? HWY_STATIC_DISPATCH(from_facets)(a, b, world_from_a, world_from_b, state)
             : HWY_STATIC_DISPATCH(from_any_state)(a, b, world_from_a, world_from_b, state);
}

DistanceResult distance(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                        TrackingState& state, const DistanceOptions& options) noexcept {
  if (has_straight_features(state) && options.depth) {
    return HWY_STATIC_DISPATCH(relative_from_straight_features)(a, b, a_from_b, state);
  }
  return has_facets(state) && options.depth
             ? HWY_STATIC_DISPATCH(relative_from_facets)(a, b, a_from_b, state)
             : HWY_STATIC_DISPATCH(relative_from_any_state)(a, b, a_from_b, state, options.depth);
}

#else
namespace {

// Caches the place in which Highway keeps the vector width that it has chosen. Highway's own
// function is in another library, and a call has to save all arguments, so it is called once.
std::atomic<const hwy::ChosenTarget*> chosen_vectors = nullptr;

// Highway's tables have no place for `noexcept`. With it the call is a jump, which saves a frame.
template <class... Args>
auto unthrowing(DistanceResult (*query)(Args...)) noexcept {
  return reinterpret_cast<DistanceResult (*)(Args...) noexcept>(query);
}

HWY_NOINLINE DistanceResult first_distance(const ConvexBody& a, const ConvexBody& b,
                                           const Pose& world_from_a, const Pose& world_from_b,
                                           TrackingState& state) noexcept {
  chosen_vectors.store(&hwy::GetChosenTarget(), std::memory_order_relaxed);
  return distance(a, b, world_from_a, world_from_b, state);
}

HWY_NOINLINE DistanceResult first_distance(const ConvexBody& a, const ConvexBody& b,
                                           const RelativePose& a_from_b, TrackingState& state,
                                           const DistanceOptions& options) noexcept {
  chosen_vectors.store(&hwy::GetChosenTarget(), std::memory_order_relaxed);
  return distance(a, b, a_from_b, state, options);
}

}  // namespace

DistanceResult distance(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                        const Pose& world_from_b, TrackingState& state) noexcept {
  const hwy::ChosenTarget* const chosen = chosen_vectors.load(std::memory_order_relaxed);
  if (HWY_UNLIKELY(chosen == nullptr)) {
    return first_distance(a, b, world_from_a, world_from_b, state);
  }
  const auto& of_widths = has_straight_features(state) ? HWY_DISPATCH_TABLE(from_straight_features)
                          : has_facets(state)          ? HWY_DISPATCH_TABLE(from_facets)
                                                       : HWY_DISPATCH_TABLE(from_any_state);
  return unthrowing(of_widths[chosen->GetIndex()])(a, b, world_from_a, world_from_b, state);
}

DistanceResult distance(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                        TrackingState& state, const DistanceOptions& options) noexcept {
  const hwy::ChosenTarget* const chosen = chosen_vectors.load(std::memory_order_relaxed);
  if (HWY_UNLIKELY(chosen == nullptr)) return first_distance(a, b, a_from_b, state, options);
  if (HWY_LIKELY(options.depth)) {
    const auto known = has_straight_features(state)
                           ? HWY_DISPATCH_TABLE(relative_from_straight_features)
                       : has_facets(state) ? HWY_DISPATCH_TABLE(relative_from_facets)
                                           : nullptr;
    if (known != nullptr) {
      return unthrowing(known[chosen->GetIndex()])(a, b, a_from_b, state);
    }
  }
  return unthrowing(HWY_DISPATCH_TABLE(relative_from_any_state)[chosen->GetIndex()])(
      a, b, a_from_b, state, options.depth);
}

#endif

TrackedQuery tracked_query() noexcept { return &HWY_DYNAMIC_DISPATCH(after_transitions); }

}  // namespace clearance
#endif  // HWY_ONCE

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

DistanceResult after_first_transition(const ConvexBody& a, const ConvexBody& b,
                                      const RelativePose4& a_from_b, TrackingState& state,
                                      TransitionsMade start, Transition first);
DistanceResult from_penetration(const ConvexBody& a, const ConvexBody& b,
                                const RelativePose4& a_from_b, TrackingState& state);
DistanceResult from_contact(const ConvexBody& a, const ConvexBody& b, const RelativePose4& a_from_b,
                            TrackingState& state, bool depth);

// Are the features where tracking ended worth a test for contact? Far below a facet's plane, as a
// part of the size, they seldom certify a depth.
inline constexpr double kShallow = 0x1p-5;
HWY_INLINE bool may_touch(const TrackedPair& pair, TrackingEnd end) {
  if (end == TrackingEnd::kExhausted) return false;
  return !(pair.distance < -kShallow * size_of(pair)) || are_facets_of_boxes(pair);
}

HWY_INLINE DistanceResult rounded_result_of(const TrackedPair& pair) {
  DistanceResult result = result_of(pair);
  add_radii(result, pair.a, pair.b);
  assert(keeps_promises(result));
  return result;
}

// Two points need no features: their states are not read.
HWY_INLINE bool are_disjoint_points(TrackedPair& pair) {
  ++pair.transitions;
  meet_points(pair);
  return HWY_LIKELY(certify<true>(pair) == TrackingEnd::kCertified);
}
// The relative pose is made again where it is needed as a whole, so that the others need no
// rotation matrix.
HWY_NOINLINE DistanceResult between_touching_points(const ConvexBody& a, const ConvexBody& b,
                                                    const Pose& world_from_a,
                                                    const Pose& world_from_b,
                                                    TrackingState& state) {
  return search_distance(a, b, pose_of(relative_pose4(world_from_a, world_from_b)), state, true);
}
HWY_NOINLINE DistanceResult between_points(const ConvexBody& a, const ConvexBody& b,
                                           const Pose& world_from_a, const Pose& world_from_b,
                                           TrackingState& state) {
  const RelativePose4 a_from_b = relative_pose4(world_from_a, world_from_b);
  TrackedPair pair(a, b, a_from_b, state);
  if (are_disjoint_points(pair)) return rounded_result_of(pair);
  return between_touching_points(a, b, world_from_a, world_from_b, state);
}
HWY_NOINLINE DistanceResult between_points(const ConvexBody& a, const ConvexBody& b,
                                           const RelativePose& relative, TrackingState& state,
                                           bool depth) {
  const RelativePose4 a_from_b = good_pose4_of(relative);
  TrackedPair pair(a, b, a_from_b, state);
  if (are_disjoint_points(pair)) return rounded_result_of(pair);
  return search_distance(a, b, pose_of(a_from_b), state, depth);
}

enum class LastFeatures { kStraight, kFacets };

// Most queries of a moving scene end here, at the features of the last query. The order of methods
// for facets that are not parallel any more is that of any state.
template <LastFeatures kFeatures, Tracking kMode = Tracking::kFirst>
HWY_INLINE DistanceResult from_features(const ConvexBody& a, const ConvexBody& b,
                                        const RelativePose4& a_from_b, TrackingState& state) {
  TrackedPair pair(a, b, a_from_b, state);
  ++pair.transitions;
  Transition first;
  if constexpr (kFeatures == LastFeatures::kFacets) {
    first = facet_facet<kMode>(pair);
  } else {
    first = transition<kMode>(pair);
  }
  if (HWY_LIKELY(first == Transition::kClosest &&
                 certify<kMode == Tracking::kFirstOfPlain>(pair) == TrackingEnd::kCertified)) {
    return rounded_result_of(pair);
  }
  return after_first_transition(a, b, a_from_b, state,
                                {pair.transitions, pair.parallel_transitions}, first);
}

// Two points or segments without features: see segments-inl.hpp.
HWY_NOINLINE DistanceResult between_segments(const ConvexBody& a, const ConvexBody& b,
                                             const RelativePose4& a_from_b, TrackingState& state) {
  start_at_segments(a, b, a_from_b, state);
  return from_features<LastFeatures::kStraight, Tracking::kFirstOfPlain>(a, b, a_from_b, state);
}

DistanceResult from_straight_features(const ConvexBody& a, const ConvexBody& b,
                                      const Pose& world_from_a, const Pose& world_from_b,
                                      TrackingState& state) {
  if (HWY_UNLIKELY(query_class(a, b) >= kTwoPoints)) {
    return from_rare_classes(a, b, world_from_a, world_from_b, state);
  }
  if (HWY_UNLIKELY(!exists(a, state.a) || !exists(b, state.b))) {
    return from_any_state(a, b, world_from_a, world_from_b, state);
  }
  return from_features<LastFeatures::kStraight, Tracking::kFirstOfPlain>(
      a, b, relative_pose4(world_from_a, world_from_b), state);
}

// Two points, or unbounded bodies.
HWY_NOINLINE DistanceResult from_rare_classes(const ConvexBody& a, const ConvexBody& b,
                                              const Pose& world_from_a, const Pose& world_from_b,
                                              TrackingState& state) {
  if (HWY_LIKELY(query_class(a, b) == kTwoPoints)) {
    return between_points(a, b, world_from_a, world_from_b, state);
  }
  if (HWY_UNLIKELY(!can_be_tracked(a, b, state))) {
    return from_any_state(a, b, world_from_a, world_from_b, state);
  }
  return from_features<LastFeatures::kStraight>(a, b, relative_pose4(world_from_a, world_from_b),
                                                state);
}

DistanceResult relative_from_straight_features(const ConvexBody& a, const ConvexBody& b,
                                               const RelativePose& a_from_b, TrackingState& state) {
  if (HWY_UNLIKELY(query_class(a, b) >= kTwoPoints)) {
    return relative_from_rare_classes(a, b, a_from_b, state);
  }
  if (HWY_UNLIKELY(!exists(a, state.a) || !exists(b, state.b))) {
    return relative_from_any_state(a, b, a_from_b, state, true);
  }
  return from_features<LastFeatures::kStraight, Tracking::kFirstOfPlain>(
      a, b, good_pose4_of(a_from_b), state);
}

HWY_NOINLINE DistanceResult relative_from_rare_classes(const ConvexBody& a, const ConvexBody& b,
                                                       const RelativePose& a_from_b,
                                                       TrackingState& state) {
  if (HWY_LIKELY(query_class(a, b) == kTwoPoints)) {
    return between_points(a, b, a_from_b, state, true);
  }
  if (HWY_UNLIKELY(!can_be_tracked(a, b, state))) {
    return relative_from_any_state(a, b, a_from_b, state, true);
  }
  return from_features<LastFeatures::kStraight>(a, b, good_pose4_of(a_from_b), state);
}

DistanceResult from_facets(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                           const Pose& world_from_b, TrackingState& state) {
  if (HWY_UNLIKELY(!can_be_tracked(a, b, state))) {
    return from_any_state(a, b, world_from_a, world_from_b, state);
  }
  return from_features<LastFeatures::kFacets>(a, b, relative_pose4(world_from_a, world_from_b),
                                              state);
}

DistanceResult relative_from_facets(const ConvexBody& a, const ConvexBody& b,
                                    const RelativePose& a_from_b, TrackingState& state) {
  if (HWY_UNLIKELY(!can_be_tracked(a, b, state))) {
    return relative_from_any_state(a, b, a_from_b, state, true);
  }
  return from_features<LastFeatures::kFacets>(a, b, good_pose4_of(a_from_b), state);
}

// The TrackedPair is a new one, so that the one of from_features() can stay in registers.
HWY_NOINLINE DistanceResult after_first_transition(const ConvexBody& a, const ConvexBody& b,
                                                   const RelativePose4& a_from_b,
                                                   TrackingState& state, TransitionsMade start,
                                                   Transition first) {
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

// A quick test before the table of closed forms: false if both bodies are bounded and one of them
// has facets.
HWY_INLINE bool may_have_closed_form(const ConvexBody& a, const ConvexBody& b) {
  return query_class(a, b) >= kTwoPoints || (a.features[2] | b.features[2]) == 0;
}

// For states without features or with parallel ones, and for penetrating bodies.
HWY_INLINE DistanceResult distance_from(const ConvexBody& a, const ConvexBody& b,
                                        const RelativePose4& a_from_b, TrackingState& state,
                                        TransitionsMade start, bool depth) {
  if (state.a.penetrating && depth) return from_penetration(a, b, a_from_b, state);
  TrackedPair pair(a, b, a_from_b, state, start);
  pair.distance = 0.0;
  const TrackingEnd end = track(pair);
  if (end == TrackingEnd::kCertified) return rounded_result_of(pair);
  if (may_touch(pair, end)) return from_contact(a, b, a_from_b, state, depth);
  return search_distance(a, b, pose_of(a_from_b), state, depth);
}

HWY_INLINE DistanceResult distance_from(const ConvexBody& a, const ConvexBody& b,
                                        const Pose& world_from_a, const Pose& world_from_b,
                                        TrackingState& state, TransitionsMade start) {
  if (HWY_UNLIKELY(may_have_closed_form(a, b))) {
    if (a.is_curved() || b.is_curved()) {
      return curved_pair_distance(a, b, world_from_a, world_from_b, state);
    }
    if (query_class(a, b) == kTwoPoints) {
      return between_points(a, b, world_from_a, world_from_b, state);
    }
    if (are_segments_without_features(a, b, state)) {
      return between_segments(a, b, relative_pose4(world_from_a, world_from_b), state);
    }
  }
  return distance_from(a, b, relative_pose4(world_from_a, world_from_b), state, start, true);
}

// There are two of these functions, because one argument more than fits into registers costs a cold
// query 3 %.
DistanceResult from_any_state(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                              const Pose& world_from_b, TrackingState& state) {
  return distance_from(a, b, world_from_a, world_from_b, state, {});
}
DistanceResult after_transitions(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                                 const Pose& world_from_b, TrackingState& state,
                                 TransitionsMade start) {
  return distance_from(a, b, world_from_a, world_from_b, state, start);
}

DistanceResult relative_from_any_state(const ConvexBody& a, const ConvexBody& b,
                                       const RelativePose& a_from_b, TrackingState& state,
                                       bool depth) {
  if (HWY_UNLIKELY(may_have_closed_form(a, b))) {
    if (a.is_curved() || b.is_curved()) {
      return is_good(a_from_b) ? curved_pair_distance(a, b, a_from_b, state, depth)
                               : of_bad_pose(state);
    }
    if (query_class(a, b) == kTwoPoints) return between_points(a, b, a_from_b, state, depth);
    if (are_segments_without_features(a, b, state) && depth) {
      return between_segments(a, b, good_pose4_of(a_from_b), state);
    }
  }
  return distance_from(a, b, good_pose4_of(a_from_b), state, {}, depth);
}

HWY_INLINE DistanceResult penetrating_result_of(const TrackedPair& pair) {
  DistanceResult result = penetration_result_of(pair);
  add_radii(result, pair.a, pair.b);
  assert(keeps_promises(result));
  return result;
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
