// distance() itself: the relative pose, the walk from the features of the last query, and what that
// leaves open. The first part is compiled once a vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/query/distance.cpp"
#include "core/numerics/simd_targets.hpp"
// That comes first.
#include "core/distance.hpp"
#include "core/feature_walk/penetrating_steps-inl.hpp"
#include "core/model/radii.hpp"
#include "core/query/search.hpp"
#include "core/query/tracked_query.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

HWY_INLINE DistanceResult rounded_result_of(const TrackedPair& pair) {
  DistanceResult result = result_of(pair);
  add_radii(result, pair.a, pair.b);
  return result;
}

// What by_walk() leaves to others has a relative pose and a pair of its own, so that those of
// by_walk() can be kept in registers.
inline HWY_NOINLINE DistanceResult walk_penetrating(const ConvexBody& a, const ConvexBody& b,
                                                    const Pose& world_from_a,
                                                    const Pose& world_from_b,
                                                    TrackingState& state) {
  const RelativePose4 a_from_b = relative_pose4(world_from_a, world_from_b);
  TrackedPair pair(a, b, a_from_b, state);
  if (!walk_penetration(pair)) {
    return by_depth(a, b, pose_of(a_from_b), state);
  }
  DistanceResult result = penetration_result_of(pair);
  add_radii(result, a, b);
  return result;
}

// From no features, from parallel ones, of bodies that penetrated each other, or of curved ones,
// which have no features. `start`: as of
// by_walk().
template <class... Start>
HWY_INLINE DistanceResult walk_from_others(const ConvexBody& a, const ConvexBody& b,
                                           const Pose& world_from_a, const Pose& world_from_b,
                                           TrackingState& state, Start... start) {
  if (HWY_UNLIKELY(a.is_curved() || b.is_curved())) {
    return by_direction(a, b, world_from_a, world_from_b, state);
  }
  if (state.a.penetrating) return walk_penetrating(a, b, world_from_a, world_from_b, state);
  const RelativePose4 a_from_b = relative_pose4(world_from_a, world_from_b);
  TrackedPair pair(a, b, a_from_b, state, start...);
  if (walk(pair) == WalkEnd::kCertified) return rounded_result_of(pair);
  return by_search(a, b, pose_of(a_from_b), state, true);
}

// After a first transition that has ended so.
inline HWY_NOINLINE DistanceResult walk_further(const ConvexBody& a, const ConvexBody& b,
                                                const RelativePose4& a_from_b, TrackingState& state,
                                                WalkStart at, Transition first) {
  TrackedPair pair(a, b, a_from_b, state, at);
  if (first == Transition::kMoved && walk_on(pair) == WalkEnd::kCertified) {
    return rounded_result_of(pair);
  }
  return by_search(a, b, pose_of(a_from_b), state, true);
}

DistanceResult tracked_from_others(const ConvexBody& a, const ConvexBody& b,
                                   const Pose& world_from_a, const Pose& world_from_b,
                                   TrackingState& state) {
  return walk_from_others(a, b, world_from_a, world_from_b, state);
}
inline HWY_NOINLINE DistanceResult continued_from_others(const ConvexBody& a, const ConvexBody& b,
                                                         const Pose& world_from_a,
                                                         const Pose& world_from_b,
                                                         TrackingState& state, WalkStart start) {
  return walk_from_others(a, b, world_from_a, world_from_b, state, start);
}

// Every query by poses: transitions until the features are closest and certified, else the search.
// `start` is a WalkStart or nothing: one argument more than fits into registers costs a query that
// begins at the beginning 1 ns. So does a query that begins at no feature if it comes by here:
// distance() looks at the state first.
template <class... Start>
HWY_INLINE DistanceResult by_walk(const ConvexBody& a, const ConvexBody& b,
                                  const Pose& world_from_a, const Pose& world_from_b,
                                  TrackingState& state, Start... start) {
  if (HWY_UNLIKELY(!is_straight(state) || !can_be_walked(a, b, state))) {
    if constexpr (sizeof...(start) == 0) {
      return tracked_from_others(a, b, world_from_a, world_from_b, state);
    } else {
      return continued_from_others(a, b, world_from_a, world_from_b, state, start...);
    }
  }
  const RelativePose4 a_from_b = relative_pose4(world_from_a, world_from_b);
  TrackedPair pair(a, b, a_from_b, state, start...);
  ++pair.transitions;
  const Transition first = transition<Tracking::kFirst>(pair);
  if (HWY_LIKELY(first == Transition::kClosest && certify(pair) == WalkEnd::kCertified)) {
    return rounded_result_of(pair);
  }
  return walk_further(a, b, a_from_b, state, {pair.transitions, pair.parallel_transitions}, first);
}

DistanceResult tracked_distance(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                                const Pose& world_from_b, TrackingState& state) {
  return by_walk(a, b, world_from_a, world_from_b, state);
}
DistanceResult continued_distance(const ConvexBody& a, const ConvexBody& b,
                                  const Pose& world_from_a, const Pose& world_from_b,
                                  TrackingState& state, WalkStart start) {
  return by_walk(a, b, world_from_a, world_from_b, state, start);
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <atomic>
#include <optional>

#include "core/feature_walk/feature_walk.hpp"
#include "core/penetration/penetration.hpp"

namespace clearance {

HWY_EXPORT(tracked_distance);
HWY_EXPORT(tracked_from_others);
HWY_EXPORT(continued_distance);

namespace {

// The spheres around the frames' origins already say that they are far apart; radii included.
std::optional<DistanceResult> far_by_spheres(const ConvexBody& a, const ConvexBody& b,
                                             const RelativePose& a_from_b,
                                             double far_away) noexcept {
  if (!(far_away < kInfinity) || !a.bounded() || !b.bounded()) return {};
  const double apart = a_from_b.translation.norm(), size = a.bounding_radius + b.bounding_radius;
  const double error = a_from_b.translation_error + 0x1p-50 * (apart + size) + kUnderflow;
  DistanceResult r;
  r.lower = apart - size - error;
  r.upper = apart + size + error;
  r.distance = r.lower;
  r.normal = a_from_b.translation / apart;
  r.point_on_a = a.interior;
  r.point_on_b = a_from_b.rotation * b.interior + a_from_b.translation;
  r.status = DistanceStatus::kFarAway;
  r.path = DistancePath::kSpheres;
  add_radii(r, a, b);
  if (!(r.lower > 0.0) || !(r.lower >= far_away)) return {};
  return r;
}

}  // namespace

const char* name(DistanceStatus status) noexcept {
  switch (status) {
    case DistanceStatus::kConverged:
      return "converged";
    case DistanceStatus::kFarAway:
      return "far_away";
    case DistanceStatus::kTouching:
      return "touching";
    case DistanceStatus::kOverlapping:
      return "overlapping";
    case DistanceStatus::kIterationLimit:
      return "iteration_limit";
    case DistanceStatus::kDepthNotAsked:
      return "depth_not_asked";
    case DistanceStatus::kBadPose:
      return "bad_pose";
  }
  return "";
}

DistanceResult distance(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                        TrackingState& state, const DistanceOptions& options) noexcept {
  if (!is_good(a_from_b)) return of_bad_pose(state);
  if (const auto far = far_by_spheres(a, b, a_from_b, options.far_away)) return *far;
  if (a.is_curved() || b.is_curved()) return by_direction(a, b, a_from_b, state, options.depth);
  DistanceResult result;
  if (state.a.penetrating && options.depth) {
    if (!walk_penetration(a, b, a_from_b, state, result)) return by_depth(a, b, a_from_b, state);
  } else if (walk_features(a, b, a_from_b, state, result) != WalkEnd::kCertified) {
    return by_search(a, b, a_from_b, state, options.depth);
  }
  add_radii(result, a, b);
  return result;
}

#if (HWY_TARGETS & (HWY_TARGETS - 1)) == 0

DistanceResult distance(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                        const Pose& world_from_b, TrackingState& state) noexcept {
  return is_straight(state)
             ? HWY_STATIC_DISPATCH(tracked_distance)(a, b, world_from_a, world_from_b, state)
             : HWY_STATIC_DISPATCH(tracked_from_others)(a, b, world_from_a, world_from_b, state);
}

#else
namespace {

// Where Highway keeps which vectors it has chosen. Looked up once: that is a call of another
// library, for which all arguments are put aside.
std::atomic<const hwy::ChosenTarget*> chosen_vectors = nullptr;

HWY_NOINLINE DistanceResult first_distance(const ConvexBody& a, const ConvexBody& b,
                                           const Pose& world_from_a, const Pose& world_from_b,
                                           TrackingState& state) noexcept {
  chosen_vectors.store(&hwy::GetChosenTarget(), std::memory_order_relaxed);
  return distance(a, b, world_from_a, world_from_b, state);
}

}  // namespace

DistanceResult distance(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                        const Pose& world_from_b, TrackingState& state) noexcept {
  const hwy::ChosenTarget* const chosen = chosen_vectors.load(std::memory_order_relaxed);
  if (HWY_UNLIKELY(chosen == nullptr)) {
    return first_distance(a, b, world_from_a, world_from_b, state);
  }
  const auto& queries = is_straight(state) ? HWY_DISPATCH_TABLE(tracked_distance)
                                           : HWY_DISPATCH_TABLE(tracked_from_others);
  return queries[chosen->GetIndex()](a, b, world_from_a, world_from_b, state);
}

#endif

TrackedQuery tracked_query() noexcept { return &HWY_DYNAMIC_DISPATCH(continued_distance); }

}  // namespace clearance
#endif
