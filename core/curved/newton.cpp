// Newton's method as a complete query: the fast one of the two efforts in README.md. Compiled once
// a vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/curved/newton.cpp"
#include "core/numerics/simd_targets.hpp"
// This include must come first.
#include "core/curved/bounds.hpp"
#include "core/curved/curved_distance.hpp"
#include "core/curved/newton-inl.hpp"
#include "core/curved/segment_and_cone-inl.hpp"
#include "core/curved/tracking.hpp"
#include "core/model/bad_pose.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// The part with the greatest support value along m (unit), or a cap if m is nearly the axis.
HWY_INLINE std::int32_t first_part(const Side& side, Vec4 m) {
  if (!side.is_round()) return support(side.body, vec3(m)).anchor;
  const double length = norm(side.semi_axes() * m);
  const std::int32_t part = support_part(side.round, lane(m, 2), length).number;
  return side.round.has_caps && !(length > kNearAxis) ? first_planar_face(side.body) + part : part;
}
inline HWY_NOINLINE Vec4 start(const Side& a, const Side& b, const RelativePose4& a_from_b, Vec4 x,
                               ActiveParts& active) {
  const Vec4 n = over(x, norm(x));
  PartPair& pair = active.pairs[0];
  pair = {first_part(a, n), first_part(b, -direction_to_b(a_from_b, n))};
  active.count = 1;
  // Parallel caps are left to the thorough effort; here one of the rims may be enough.
  const std::int32_t face_of_b = first_planar_face(b.body);
  if (pair.a >= first_planar_face(a.body) && pair.b >= face_of_b) pair.b -= face_of_b;
  return n;
}

HWY_INLINE void conclude(const ConvexBody& a, const ConvexBody& b, const RelativePose4& a_from_b,
                         const NewtonEnd& end, double size, CurvedTrackingState& state,
                         DistanceResult& r) {
  CurvedConclusion found;
  found.lower = end.lower;
  found.upper = end.upper;
  found.error = rounding_error(
      {&a, a.bounding_radius}, {&b, b.bounding_radius},
      {a_from_b.rotation_error, a_from_b.translation_error, a_from_b.translation_length}, end.upper,
      size);
  found.size = size;
  found.radius_a = a.radius;
  found.radius_b = b.radius;
  found.normal = vec3(end.normal);
  found.point_on_a = vec3(end.on_a);
  found.point_on_b = vec3(end.on_b);
  state.point_on_b_in_b = vec3(end.on_b_in_b);
  r = conclude(found);
  r.iterations = static_cast<std::uint16_t>(end.supports);
}

HWY_INLINE bool newton(const ConvexBody& a, const ConvexBody& b, const RelativePose4& a_from_b,
                       CurvedTrackingState& state, DistanceResult& r) {
  if (!a.bounded() || !b.bounded() || !(a.is_curved() || b.is_curved())) return false;
  Vec4 x = load3(state.normal);
  if (HWY_UNLIKELY(state.normal.isZero(0.0))) {
    if (!(a_from_b.translation_length > 0.0)) return false;
    x = a_from_b.translation;
    state.active.count = 0;
  }
  const Side side_a = side_of(a), side_b = side_of(b);
  // The thorough effort answers bodies whose smooth parts are not round.
  if (a.is_curved() != side_a.is_round() || b.is_curved() != side_b.is_round()) return false;
  if (HWY_UNLIKELY(state.active.count == 0)) x = start(side_a, side_b, a_from_b, x, state.active);
  const double size = a.bounding_radius + b.bounding_radius + a_from_b.translation_length;
  const auto run = [&](const auto& squares_a, const auto& squares_b) HWY_ATTR {
    Newton<std::remove_cvref_t<decltype(squares_a)>, std::remove_cvref_t<decltype(squares_b)>>
        newton(side_a, side_b, a_from_b, squares_a, squares_b, 0x1p-50 * size, x,
               state.overlap != Overlap::kTried, state.active);
    if (!newton.run()) {
      if (newton.end.overlap) {
        state.normal = vec3(newton.end.normal);
        state.overlap = Overlap::kStationary;
      }
      return false;
    }
    state.normal = vec3(newton.next_start());
    conclude(a, b, a_from_b, newton.end, size, state, r);
    return true;
  };
  if (!a.is_curved()) return run(NoSquares(), squares_of_b(side_b, a_from_b.rotation));
  if (!b.is_curved()) return run(squares_of_a(side_a), NoSquares());
  return run(squares_of_a(side_a), squares_of_b(side_b, a_from_b.rotation));
}

bool closed_form_of_relative(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                             TrackingState& state, DistanceResult& r) {
  return meet_segment_and_cone(a, b, pose4_of(a_from_b), state, r);
}

bool newton_of_relative(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                        CurvedTrackingState& state, DistanceResult& r) {
  return newton(a, b, pose4_of(a_from_b), state, r);
}

inline HWY_NOINLINE DistanceResult open_distance(const ConvexBody& a, const ConvexBody& b,
                                                 const RelativePose& a_from_b,
                                                 CurvedTrackingState& tracked,
                                                 TrackingState& state) {
  if (!is_good(a_from_b)) return of_bad_pose(state);
  const DistanceResult r = thorough_distance(a, b, a_from_b, tracked, true);
  write(tracked, a, b, state);
  return r;
}

DistanceResult distance_of_poses(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                                 const Pose& world_from_b, TrackingState& state) {
  const RelativePose4 a_from_b = relative_pose4(world_from_a, world_from_b);
  DistanceResult r;
  if (meet_segment_and_cone(a, b, a_from_b, state, r)) return r;
  CurvedTrackingState tracked = read(state, a, b);
  if (HWY_UNLIKELY(!newton(a, b, a_from_b, tracked, r))) {
    return open_distance(a, b, pose_of(a_from_b), tracked, state);
  }
  write(tracked, a, b, state);
  return r;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clearance {

HWY_EXPORT(closed_form_of_relative);
HWY_EXPORT(newton_of_relative);
HWY_EXPORT(distance_of_poses);

bool closed_form_distance(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                          TrackingState& state, DistanceResult& result) noexcept {
  return HWY_DYNAMIC_DISPATCH(closed_form_of_relative)(a, b, a_from_b, state, result);
}
bool newton_distance(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                     CurvedTrackingState& state, DistanceResult& result) noexcept {
  return HWY_DYNAMIC_DISPATCH(newton_of_relative)(a, b, a_from_b, state, result);
}
DistanceResult curved_distance(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                               const Pose& world_from_b, TrackingState& state) noexcept {
  return HWY_DYNAMIC_DISPATCH(distance_of_poses)(a, b, world_from_a, world_from_b, state);
}

}  // namespace clearance
#endif
