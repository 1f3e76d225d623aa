#include "core/distance_result.hpp"

namespace clearance {

const char* name(DistanceStatus status) noexcept {
  switch (status) {
    case DistanceStatus::kConverged:
      return "converged";
    case DistanceStatus::kTouching:
      return "touching";
    case DistanceStatus::kOverlapping:
      return "overlapping";
    case DistanceStatus::kIterationLimit:
      return "iteration_limit";
    case DistanceStatus::kDepthNotAsked:
      return "depth_not_asked";
    case DistanceStatus::kBadPose:
      return "bad_pose";
  }
  return "";
}

}  // namespace clearance
