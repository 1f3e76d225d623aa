// Compiled once per vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/model/pose.cpp"
#include "core/numerics/simd_targets.hpp"
// The include above must come first.
#include "core/model/relative_pose-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

RelativePose relate(const Pose& world_from_a, const Pose& world_from_b) {
  return pose_of(relative_pose4(world_from_a, world_from_b));
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clearance {

HWY_EXPORT(relate);

Vec3 transform(const Pose& pose, const Vec3& point) noexcept {
  return rotation_matrix(pose.orientation) * point + pose.position;
}

Pose compose(const Pose& outer, const Pose& inner) noexcept {
  return {transform(outer, inner.position), (outer.orientation * inner.orientation).normalized()};
}

RelativePose relative_pose(const Pose& world_from_a, const Pose& world_from_b) noexcept {
  return HWY_DYNAMIC_DISPATCH(relate)(world_from_a, world_from_b);
}

}  // namespace clearance
#endif
