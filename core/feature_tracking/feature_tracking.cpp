// Compiled once a vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/feature_tracking/feature_tracking.cpp"
#include "core/numerics/simd_targets.hpp"
// The include above must come first.
#include "core/feature_tracking/transitions-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

TrackingEnd track_relative(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                           TrackingState& state, DistanceResult& r) {
  const RelativePose4 pose4 = pose4_of(a_from_b);
  TrackedPair pair(a, b, pose4, state);
  const TrackingEnd end = track(pair);
  if (are_closest(end)) r = result_of(pair);
  return end;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clearance {

HWY_EXPORT(track_relative);

TrackingEnd track_features(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                           TrackingState& state, DistanceResult& result) noexcept {
  return HWY_DYNAMIC_DISPATCH(track_relative)(a, b, a_from_b, state, result);
}

}  // namespace clearance
#endif
