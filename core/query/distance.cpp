// Compiled once a vector width, as far as the walk goes.
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

HWY_INLINE DistanceResult rounded_result_of(const Walk& w) {
  DistanceResult result = result_of(w);
  add_radii(result, w.a, w.b);
  return result;
}

// With a pose and a walk of its own, so that those of the others can be kept in registers.
inline HWY_NOINLINE DistanceResult tracked_overlap(const ConvexPolyhedron& a,
                                                   const ConvexPolyhedron& b,
                                                   const Pose& world_from_a,
                                                   const Pose& world_from_b, TrackingState& state) {
  const RelativeQuads a_from_b = relative_quads(world_from_a, world_from_b);
  Walk w(a, b, a_from_b, state);
  if (!walk_overlap(w)) {
    return by_depth(a, b, pose_of(a_from_b), state);
  }
  DistanceResult result = overlap_result_of(w);
  add_radii(result, a, b);
  return result;
}

// Of pairs that begin at no feature, or whose first step is not straight-line code.
HWY_INLINE DistanceResult walked_anyhow(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                        const Pose& world_from_a, const Pose& world_from_b,
                                        TrackingState& state, WalkStart start) {
  if (state.a.deep) return tracked_overlap(a, b, world_from_a, world_from_b, state);
  const RelativeQuads a_from_b = relative_quads(world_from_a, world_from_b);
  Walk w(a, b, a_from_b, state);
  w.steps = start.steps;
  w.levels = start.levels;
  if (walk(w) == WalkEnd::kProved) return rounded_result_of(w);
  return by_search(a, b, pose_of(a_from_b), state, true);
}

// After a first step that has ended so; with a walk of its own, as above.
inline HWY_NOINLINE DistanceResult walked_on(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                             const Pose& world_from_a, const Pose& world_from_b,
                                             const RelativeQuads& a_from_b, TrackingState& state,
                                             WalkStart at, Step first) {
  Walk w(a, b, a_from_b, state);
  w.steps = at.steps;
  w.levels = at.levels;
  if (first == Step::kMoved && walk_on(w) == WalkEnd::kProved) return rounded_result_of(w);
  return by_search(a, b, pose_of(a_from_b), state, true);
}

// A walk's first step where that is straight-line code: nothing here needs the walk in memory, so
// that what the step finds stays in registers. As a case of step() it costs boxes 3 % more.
HWY_INLINE Step first_step(Walk& w) {
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
      return edge_edge<true>(w);
    default:
      return facet_vertex(Owned<false>{w});
  }
}

HWY_INLINE DistanceResult walked_straight(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                          const Pose& world_from_a, const Pose& world_from_b,
                                          TrackingState& state, WalkStart start) {
  const RelativeQuads a_from_b = relative_quads(world_from_a, world_from_b);
  Walk w(a, b, a_from_b, state);
  w.steps = start.steps + 1;
  w.levels = start.levels;
  const Step first = first_step(w);
  if (HWY_LIKELY(first == Step::kHolds && conclude(w) == WalkEnd::kProved)) {
    return rounded_result_of(w);
  }
  return walked_on(a, b, world_from_a, world_from_b, a_from_b, state, {w.steps, w.levels}, first);
}

// Two of each: another argument costs a query that begins at the beginning 1 ns.
DistanceResult tracked_anyhow(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                              const Pose& world_from_a, const Pose& world_from_b,
                              TrackingState& state) {
  return walked_anyhow(a, b, world_from_a, world_from_b, state, {});
}
// From features that are straight.
DistanceResult tracked_straight(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                const Pose& world_from_a, const Pose& world_from_b,
                                TrackingState& state) {
  if (HWY_UNLIKELY(!can_be_walked(a, b, state))) {
    return tracked_anyhow(a, b, world_from_a, world_from_b, state);
  }
  return walked_straight(a, b, world_from_a, world_from_b, state, {});
}
inline HWY_NOINLINE DistanceResult departed_anyhow(const ConvexPolyhedron& a,
                                                   const ConvexPolyhedron& b,
                                                   const Pose& world_from_a,
                                                   const Pose& world_from_b, TrackingState& state,
                                                   WalkStart start) {
  return walked_anyhow(a, b, world_from_a, world_from_b, state, start);
}
DistanceResult departed_distance(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                 const Pose& world_from_a, const Pose& world_from_b,
                                 TrackingState& state, WalkStart start) {
  if (!is_straight(state) || !can_be_walked(a, b, state)) {
    return departed_anyhow(a, b, world_from_a, world_from_b, state, start);
  }
  return walked_straight(a, b, world_from_a, world_from_b, state, start);
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <atomic>
#include <optional>

#include "core/feature_walk/feature_walk.hpp"
#include "core/penetration/penetration.hpp"

namespace clearance {

HWY_EXPORT(tracked_straight);
HWY_EXPORT(tracked_anyhow);
HWY_EXPORT(departed_distance);

namespace {

// The spheres around the frames' origins already say that they are far apart; radii included.
std::optional<DistanceResult> far_by_spheres(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                             const RelativePose& a_from_b,
                                             double far_away) noexcept {
  if (!(far_away < kInfinity) || !a.bounded() || !b.bounded()) return {};
  const double apart = a_from_b.translation.norm(), size = a.bounding_radius + b.bounding_radius;
  const double slack = a_from_b.translation_error + 0x1p-50 * (apart + size) + kUnderflow;
  DistanceResult r;
  r.lower = apart - size - slack;
  r.upper = apart + size + slack;
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

DistanceResult distance(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                        const RelativePose& a_from_b, TrackingState& state,
                        const DistanceOptions& options) noexcept {
  if (!is_good(a_from_b)) return of_bad_pose();
  if (const auto far = far_by_spheres(a, b, a_from_b, options.far_away)) return *far;
  DistanceResult result;
  if (state.a.deep && options.depth) {
    if (!walk_overlap(a, b, a_from_b, state, result)) return by_depth(a, b, a_from_b, state);
  } else if (walk_features(a, b, a_from_b, state, result) != WalkEnd::kProved) {
    return by_search(a, b, a_from_b, state, options.depth);
  }
  add_radii(result, a, b);
  return result;
}

#if (HWY_TARGETS & (HWY_TARGETS - 1)) == 0

DistanceResult distance(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                        const Pose& world_from_a, const Pose& world_from_b,
                        TrackingState& state) noexcept {
  return is_straight(state)
             ? HWY_STATIC_DISPATCH(tracked_straight)(a, b, world_from_a, world_from_b, state)
             : HWY_STATIC_DISPATCH(tracked_anyhow)(a, b, world_from_a, world_from_b, state);
}

#else
namespace {

// Where Highway keeps which vectors it has chosen. Looked up once: that is a call of another
// library, for which all arguments are put aside.
std::atomic<const hwy::ChosenTarget*> chosen_vectors = nullptr;

HWY_NOINLINE DistanceResult first_distance(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                           const Pose& world_from_a, const Pose& world_from_b,
                                           TrackingState& state) noexcept {
  chosen_vectors.store(&hwy::GetChosenTarget(), std::memory_order_relaxed);
  return distance(a, b, world_from_a, world_from_b, state);
}

}  // namespace

DistanceResult distance(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                        const Pose& world_from_a, const Pose& world_from_b,
                        TrackingState& state) noexcept {
  const hwy::ChosenTarget* const chosen = chosen_vectors.load(std::memory_order_relaxed);
  if (HWY_UNLIKELY(chosen == nullptr)) {
    return first_distance(a, b, world_from_a, world_from_b, state);
  }
  const auto& queries = is_straight(state) ? HWY_DISPATCH_TABLE(tracked_straight)
                                           : HWY_DISPATCH_TABLE(tracked_anyhow);
  return queries[chosen->GetIndex()](a, b, world_from_a, world_from_b, state);
}

#endif

TrackedQuery tracked_query() noexcept { return &HWY_DYNAMIC_DISPATCH(departed_distance); }

}  // namespace clearance
#endif
