#include "monitor/report.hpp"

namespace clearance {

const char* name(PairStatus status) noexcept {
  switch (status) {
    case PairStatus::kConverged:
      return "converged";
    case PairStatus::kTouching:
      return "touching";
    case PairStatus::kOverlapping:
      return "overlapping";
    case PairStatus::kIterationLimit:
      return "iteration_limit";
    case PairStatus::kCarried:
      return "carried";
    case PairStatus::kStale:
      return "stale";
    case PairStatus::kUnknown:
      return "unknown";
    case PairStatus::kAbsent:
      return "absent";
  }
  return "";
}

}  // namespace clearance
