// Newton's method as a complete query: the fast one of the two efforts in README.md. Compiled once
// per vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/curved/newton.cpp"
#include "core/numerics/simd_targets.hpp"
// This include must come first.
#include "core/curved/bounds.hpp"
#include "core/curved/curved-inl.hpp"
#include "core/curved/curved_distance.hpp"
#include "core/curved/newton-inl.hpp"
#include "core/curved/segment_and_cone-inl.hpp"
#include "core/curved/tracking.hpp"
#include "core/model/bad_pose.hpp"

#include <cassert>

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
  CurvedConclusion found{};
  found.lower = end.lower;
  found.upper = end.upper;
  found.error = rounding_error({&a, a.bounding_radius}, {&b, b.bounding_radius}, place_of(a_from_b),
                               end.upper, size);
  found.size = size;
  found.normal = vec3(end.normal);
  found.point_on_a = vec3(end.on_a);
  found.point_on_b = vec3(end.on_b);
  state.point_on_b_B = vec3(end.on_b_B);
  r = conclude(a, b, found);
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
  const double size = size_of(a, b, a_from_b.translation_length);
  const auto run = [&](const auto& squares_a, const auto& squares_b) HWY_ATTR {
    Newton<std::remove_cvref_t<decltype(squares_a)>, std::remove_cvref_t<decltype(squares_b)>>
        newton(side_a, side_b, a_from_b, squares_a, squares_b, 0x1p-50 * size, x,
               state.overlap != Overlap::kNoDepth, state.active);
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

bool newton_of_relative(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                        CurvedTrackingState& state, DistanceResult& r) {
  return newton(a, b, pose4_of(a_from_b), state, r);
}

inline HWY_NOINLINE void left_open(const Query4& q, CurvedTrackingState& tracked,
                                   DistanceResult& r) {
  const RelativePose a_from_b = pose_of(q.a_from_b);
  if (!is_good(a_from_b)) {
    r = of_bad_pose(q.state);
    return;
  }
  r = thorough_distance({q.a, q.b, a_from_b, q.state, q.depth}, tracked);
  const bool is_known = r.upper < 0.0 && r.status != DistanceStatus::kIterationLimit;
  if (!q.depth && !(r.lower > 0.0) && !is_known) r.status = DistanceStatus::kDepthNotAsked;
  write(tracked, q.a, q.b, q.state);
}

void curved_distance(const Query4& q, DistanceResult& r) {
  assert(q.a.is_curved() || q.b.is_curved() || q.a.bounded() || q.b.bounded());
  if (segment_and_cone_distance(q.a, q.b, q.a_from_b, q.state, r)) return;
  CurvedTrackingState tracked = read(q.state, q.a, q.b);
  if (HWY_UNLIKELY(!newton(q.a, q.b, q.a_from_b, tracked, r))) return left_open(q, tracked, r);
  write(tracked, q.a, q.b, q.state);
}

DistanceResult distance_of_relative(const Query& q) {
  DistanceResult r;
  curved_distance({q.a, q.b, pose4_of(q.a_from_b), q.state, q.depth}, r);
  return r;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clearance {

HWY_EXPORT(newton_of_relative);
HWY_EXPORT(distance_of_relative);

bool newton_distance(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                     CurvedTrackingState& state, DistanceResult& result) noexcept {
  return HWY_DYNAMIC_DISPATCH(newton_of_relative)(a, b, a_from_b, state, result);
}
DistanceResult curved_distance(const ConvexBody& a, const ConvexBody& b,
                               const RelativePose& a_from_b, TrackingState& state,
                               bool depth) noexcept {
  return HWY_DYNAMIC_DISPATCH(distance_of_relative)({a, b, a_from_b, state, depth});
}

}  // namespace clearance
#endif
