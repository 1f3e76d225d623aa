// Compiled once a vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/feature_tracking/feature_tracking.cpp"
#include "core/numerics/simd_targets.hpp"
// The include above must come first.
#include "core/feature_tracking/penetrating_transitions-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

TrackingEnd track_relative(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                           TrackingState& state, DistanceResult& r) {
  const RelativePose4 pose4 = pose4_of(a_from_b);
  TrackedPair pair(a, b, pose4, state);
  const TrackingEnd end = track(pair);
  if (end != TrackingEnd::kUndecided) r = result_of(pair);
  return end;
}

bool track_relative_penetrating(const ConvexBody& a, const ConvexBody& b,
                                const RelativePose& a_from_b, TrackingState& state,
                                DistanceResult& r) {
  const RelativePose4 pose4 = pose4_of(a_from_b);
  TrackedPair pair(a, b, pose4, state);
  if (!track_penetrating_features(pair)) return false;
  r = penetration_result_of(pair);
  return true;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clearance {

HWY_EXPORT(track_relative);
HWY_EXPORT(track_relative_penetrating);

TrackingEnd track_features(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                           TrackingState& state, DistanceResult& result) noexcept {
  return HWY_DYNAMIC_DISPATCH(track_relative)(a, b, a_from_b, state, result);
}

bool track_penetrating_features(const ConvexBody& a, const ConvexBody& b,
                                const RelativePose& a_from_b, TrackingState& state,
                                DistanceResult& result) noexcept {
  return HWY_DYNAMIC_DISPATCH(track_relative_penetrating)(a, b, a_from_b, state, result);
}

}  // namespace clearance
#endif
