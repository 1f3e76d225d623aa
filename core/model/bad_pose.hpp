// Relative poses that no query can answer.
#pragma once

#include <limits>

#include "core/convex_body.hpp"
#include "core/distance_result.hpp"
#include "core/numerics/error_constants.hpp"
#include "core/pose.hpp"

namespace clearance {

// Is the pose finite, and is the translation at most kLargestCoordinate long?
[[nodiscard]] inline bool is_good(const RelativePose& pose) noexcept {
  return pose.rotation.allFinite() && pose.translation.norm() <= kLargestCoordinate;
}

// The answer for a pose that is not good. The state becomes cold, because its contents after such a
// pose would depend on the query's path.
[[nodiscard]] inline DistanceResult of_bad_pose(TrackingState& state) noexcept {
  state = {};
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  DistanceResult r;
  r.distance = kNaN;
  r.lower = -kInfinity;
  r.upper = kInfinity;
  r.normal = r.point_on_a = r.point_on_b = Vec3::Constant(kNaN);
  r.status = DistanceStatus::kBadPose;
  return r;
}

}  // namespace clearance
