// Compiled once a vector width, as far as the walk goes.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/distance.cpp"
#include "core/vector_widths.hpp"
// That comes first.
#include "core/overlap_walk-inl.hpp"
#include "core/radii.hpp"
#include "core/search.hpp"
#include "core/tracked_query.hpp"

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
    return by_depth(a, b, pose_of(a_from_b, world_from_a, world_from_b), state);
  }
  DistanceResult result = overlap_result_of(w);
  add_radii(result, a, b);
  return result;
}

HWY_INLINE DistanceResult walked_distance(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                          const Pose& world_from_a, const Pose& world_from_b,
                                          TrackingState& state, WalkStart start) {
  if (HWY_UNLIKELY(state.a.deep)) return tracked_overlap(a, b, world_from_a, world_from_b, state);
  const RelativeQuads a_from_b = relative_quads(world_from_a, world_from_b);
  Walk w(a, b, a_from_b, state);
  w.steps = start.steps;
  w.levels = start.levels;
  if (walk(w) == WalkEnd::kProved) return rounded_result_of(w);
  return by_search(a, b, pose_of(a_from_b, world_from_a, world_from_b), state, true);
}

// Two of it: another argument costs a query that begins at the beginning 1 ns.
DistanceResult tracked_distance(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                const Pose& world_from_a, const Pose& world_from_b,
                                TrackingState& state) {
  return walked_distance(a, b, world_from_a, world_from_b, state, {});
}
DistanceResult departed_distance(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                 const Pose& world_from_a, const Pose& world_from_b,
                                 TrackingState& state, WalkStart start) {
  return walked_distance(a, b, world_from_a, world_from_b, state, start);
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <optional>

#include "core/feature_walk.hpp"
#include "core/overlap.hpp"

namespace clearance {

HWY_EXPORT(tracked_distance);
HWY_EXPORT(departed_distance);

namespace {

// The spheres around the frames' origins already say that they are far apart; radii included.
std::optional<DistanceResult> far_by_spheres(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                             const RelativePose& a_from_b,
                                             double far_away) noexcept {
  if (!(far_away < kInfinity) || !a.bounded() || !b.bounded()) return {};
  const double apart = a_from_b.translation.norm(), size = a.bounding_radius + b.bounding_radius;
  const double slack = a_from_b.translation_error + 0x1p-50 * (apart + size);
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
  }
  return "";
}

DistanceResult distance(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                        const RelativePose& a_from_b, TrackingState& state,
                        const DistanceOptions& options) noexcept {
  if (!is_a_place(a_from_b)) return nothing_known();
  if (const auto far = far_by_spheres(a, b, a_from_b, options.far_away)) return *far;
  DistanceResult result;
  if (state.a.deep && options.depth) {
    if (!walk_overlap(a, b, a_from_b, state, result)) return by_depth(a, b, a_from_b, state);
  } else if (walk_features(a, b, a_from_b, state, result) != WalkEnd::kProved) {
    return by_search(a, b, a_from_b, state, options.depth);
  }
  finish(a, b, result);
  return result;
}

DistanceResult distance(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                        const Pose& world_from_a, const Pose& world_from_b,
                        TrackingState& state) noexcept {
  return HWY_DYNAMIC_DISPATCH(tracked_distance)(a, b, world_from_a, world_from_b, state);
}

TrackedQuery tracked_query() noexcept { return &HWY_DYNAMIC_DISPATCH(departed_distance); }

}  // namespace clearance
#endif
