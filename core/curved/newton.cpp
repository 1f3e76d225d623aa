// Compiled once a vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/curved/newton.cpp"
#include "core/numerics/simd_targets.hpp"
// That comes first.
#include "core/curved/conclusion.hpp"
#include "core/curved/curved_pair.hpp"
#include "core/curved/newton-inl.hpp"
#include "core/curved/newton.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// The piece that reaches farthest along m (unit); of a truncated cone whose axis that is, the cap.
HWY_INLINE std::int32_t first_piece(const ConvexBody& body, const Vec3& m) {
  switch (body.curved.kind) {
    case CurvedShape::Kind::kNone:
      return support(body, m).anchor;
    case CurvedShape::Kind::kEllipsoid:
      return 0;
    case CurvedShape::Kind::kTruncatedCone:
      break;
  }
  const double across = std::sqrt(m.x() * m.x() + m.y() * m.y());
  const auto& [low, high] = body.curved.discs;
  const bool is_high =
      high.height * m.z() + high.radius * across > low.height * m.z() + low.radius * across;
  return (across > kNearAxis ? 0 : 2) + (is_high ? 1 : 0);
}
inline HWY_NOINLINE Vec4 start(const ConvexBody& a, const ConvexBody& b,
                               const RelativePose4& a_from_b, Vec4 x, ActivePieces& active) {
  const Vec4 n = over(x, norm(x));
  PiecePair& pieces = active.pieces[0];
  pieces = {first_piece(a, vec3(n)), first_piece(b, vec3(-direction_to_b(a_from_b, n)))};
  active.count = 1;
  // Parallel caps are left to the search; here one of the rims may do.
  if (pieces.a >= first_flat(a) && pieces.b >= first_flat(b)) pieces.b -= first_flat(b);
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
  state.own_point_on_b = vec3(end.own_b);
  r = conclude(found);
  r.iterations = static_cast<std::uint16_t>(end.supports);
  if (HWY_UNLIKELY(!(r.lower > 0.0))) {
    state.shared = between(found.point_on_a, found.point_on_b, a.radius, b.radius);
  }
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
  if (HWY_UNLIKELY(state.active.count == 0)) x = start(a, b, a_from_b, x, state.active);
  const double size = a.bounding_radius + b.bounding_radius + a_from_b.translation_length;
  const auto run = [&](const auto& round_a, const auto& round_b) HWY_ATTR {
    Newton<std::remove_cvref_t<decltype(round_a)>, std::remove_cvref_t<decltype(round_b)>> pair(
        a, b, a_from_b, round_a, round_b, 0x1p-50 * size, x, state.active);
    if (!pair.run()) return false;
    state.normal = vec3(pair.next_start());
    conclude(a, b, a_from_b, pair.end, size, state, r);
    return true;
  };
  if (!a.is_curved()) return run(NoRoundness(), roundness_of_b(b, a_from_b.rotation));
  if (!b.is_curved()) return run(roundness_of_a(a), NoRoundness());
  return run(roundness_of_a(a), roundness_of_b(b, a_from_b.rotation));
}

bool newton_of_relative(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                        CurvedTrackingState& state, DistanceResult& r) {
  return newton(a, b, pose4_of(a_from_b), state, r);
}

DistanceResult newton_of_poses(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                               const Pose& world_from_b, TrackingState& state,
                               OtherDistance otherwise) {
  const RelativePose4 a_from_b = relative_pose4(world_from_a, world_from_b);
  CurvedTrackingState tracked = read(state, a, b);
  DistanceResult r;
  if (HWY_UNLIKELY(!newton(a, b, a_from_b, tracked, r))) {
    return otherwise(a, b, pose_of(a_from_b), state, true);
  }
  write(tracked, a, b, state);
  return r;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clearance {

HWY_EXPORT(newton_of_relative);
HWY_EXPORT(newton_of_poses);

bool newton_distance(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                     CurvedTrackingState& state, DistanceResult& result) noexcept {
  return HWY_DYNAMIC_DISPATCH(newton_of_relative)(a, b, a_from_b, state, result);
}
DistanceResult newton_distance(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                               const Pose& world_from_b, TrackingState& state,
                               OtherDistance otherwise) noexcept {
  return HWY_DYNAMIC_DISPATCH(newton_of_poses)(a, b, world_from_a, world_from_b, state, otherwise);
}

}  // namespace clearance
#endif
