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

const char* name(ZoneCause cause) noexcept {
  switch (cause) {
    case ZoneCause::kInactive:
      return "inactive";
    case ZoneCause::kNear:
      return "near";
    case ZoneCause::kLate:
      return "late";
    case ZoneCause::kUnknown:
      return "unknown";
    case ZoneCause::kDiscontinuous:
      return "discontinuous";
    case ZoneCause::kContradicted:
      return "contradicted";
  }
  return "";
}

const char* name(GradientStatus status) noexcept {
  switch (status) {
    case GradientStatus::kUnknown:
      return "unknown";
    case GradientStatus::kUnique:
      return "unique";
    case GradientStatus::kOneOfSeveral:
      return "one_of_several";
    case GradientStatus::kPartsCompared:
      return "parts_compared";
  }
  return "";
}

const char* name(SeparationValidity validity) noexcept {
  switch (validity) {
    case SeparationValidity::kUnknown:
      return "unknown";
    case SeparationValidity::kAssumed:
      return "assumed";
    case SeparationValidity::kMeasured:
      return "measured";
    case SeparationValidity::kAbsent:
      return "absent";
  }
  return "";
}

}  // namespace clearance
