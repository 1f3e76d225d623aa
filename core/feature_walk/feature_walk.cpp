// Compiled once a vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/feature_walk/feature_walk.cpp"
#include "core/numerics/simd_targets.hpp"
// That comes first.
#include "core/feature_walk/penetrating_steps-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

WalkEnd walk_relative(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                      TrackingState& state, DistanceResult& r) {
  const RelativePose4 pose4 = pose4_of(a_from_b);
  TrackedPair pair(a, b, pose4, state);
  const WalkEnd end = walk(pair);
  if (end != WalkEnd::kUndecided) r = result_of(pair);
  return end;
}

bool walk_relative_penetration(const ConvexBody& a, const ConvexBody& b,
                               const RelativePose& a_from_b, TrackingState& state,
                               DistanceResult& r) {
  const RelativePose4 pose4 = pose4_of(a_from_b);
  TrackedPair pair(a, b, pose4, state);
  if (!walk_penetration(pair)) return false;
  r = penetration_result_of(pair);
  return true;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clearance {

HWY_EXPORT(walk_relative);
HWY_EXPORT(walk_relative_penetration);

WalkEnd walk_features(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                      TrackingState& state, DistanceResult& result) noexcept {
  return HWY_DYNAMIC_DISPATCH(walk_relative)(a, b, a_from_b, state, result);
}

bool walk_penetration(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                      TrackingState& state, DistanceResult& result) noexcept {
  return HWY_DYNAMIC_DISPATCH(walk_relative_penetration)(a, b, a_from_b, state, result);
}

}  // namespace clearance
#endif
