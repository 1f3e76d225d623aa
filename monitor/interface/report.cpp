#include "monitor/interface/report.hpp"

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
    case ZoneCause::kContactTooDeep:
      return "contact_too_deep";
    case ZoneCause::kContactTooLate:
      return "contact_too_late";
    case ZoneCause::kNoShare:
      return "no_share";
  }
  return "";
}

const char* name(ContactStatus status) noexcept {
  switch (status) {
    case ContactStatus::kUnknown:
      return "unknown";
    case ContactStatus::kAllowed:
      return "allowed";
    case ContactStatus::kTooDeep:
      return "too_deep";
    case ContactStatus::kEnded:
      return "ended";
    case ContactStatus::kTooLate:
      return "too_late";
    case ContactStatus::kAbsent:
      return "absent";
  }
  return "";
}

const char* name(ContactEnded ended) noexcept {
  switch (ended) {
    case ContactEnded::kNot:
      return "not";
    case ContactEnded::kByDistance:
      return "by_distance";
    case ContactEnded::kByTime:
      return "by_time";
    case ContactEnded::kByCycle:
      return "by_cycle";
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
