// Compiled once per vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/feature_tracking/feature_tracking.cpp"
#include "core/numerics/simd_targets.hpp"
// The include above must come first.
#include <cassert>

#include "core/feature_tracking/transitions-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

TrackingEnd track_relative(const Query& query, Answer& answer) {
  assert(!query.a.is_curved() && !query.b.is_curved());
  const RelativePose4 a_from_b = pose4_of(query.a_from_b);
  const Query4 query4{query.a, query.b, a_from_b, query.state, query.depth};
  if (!has_features(query) && begin(query4) == Start::kInContact) return TrackingEnd::kUndecided;
  TrackedPair pair(query4);
  const TrackingEnd end = move_to_closest(pair);
  if (are_closest(end)) write(pair, answer);
  return end;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clearance {

HWY_EXPORT(track_relative);

TrackingEnd track_features(const Query& query, Answer& answer) noexcept {
  return HWY_DYNAMIC_DISPATCH(track_relative)(query, answer);
}

}  // namespace clearance
#endif
