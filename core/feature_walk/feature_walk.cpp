// Compiled once a vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/feature_walk/feature_walk.cpp"
#include "core/numerics/simd_targets.hpp"
// That comes first.
#include "core/feature_walk/penetrating_steps-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

WalkEnd walk_relative(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                      const RelativePose& a_from_b, TrackingState& state, DistanceResult& r) {
  const RelativeQuads quads = quads_of(a_from_b);
  Walk w(a, b, quads, state);
  const WalkEnd end = walk(w);
  if (end != WalkEnd::kLost) r = result_of(w);
  return end;
}

bool walk_relative_overlap(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                           const RelativePose& a_from_b, TrackingState& state, DistanceResult& r) {
  const RelativeQuads quads = quads_of(a_from_b);
  Walk w(a, b, quads, state);
  if (!walk_overlap(w)) return false;
  r = overlap_result_of(w);
  return true;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clearance {

HWY_EXPORT(walk_relative);
HWY_EXPORT(walk_relative_overlap);

WalkEnd walk_features(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                      const RelativePose& a_from_b, TrackingState& state,
                      DistanceResult& result) noexcept {
  return HWY_DYNAMIC_DISPATCH(walk_relative)(a, b, a_from_b, state, result);
}

bool walk_overlap(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                  const RelativePose& a_from_b, TrackingState& state,
                  DistanceResult& result) noexcept {
  return HWY_DYNAMIC_DISPATCH(walk_relative_overlap)(a, b, a_from_b, state, result);
}

}  // namespace clearance
#endif
