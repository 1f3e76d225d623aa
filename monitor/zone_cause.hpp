// The reason why a zone is active, as text for all programs.
#pragma once

#include <string>

#include "monitor/report.hpp"

namespace clearance {

// Returns, for example, "by distance" or "poses of hand are late", or an empty text if the zone is
// not active. `object` is the name of ZoneReport::cause_object.
[[nodiscard]] inline std::string cause_text(ZoneCause cause, const std::string& object) {
  switch (cause) {
    case ZoneCause::kInactive:
      return "";
    case ZoneCause::kNear:
      return "by distance";
    case ZoneCause::kLate:
      return "poses of " + object + " are late";
    case ZoneCause::kUnknown:
      return "no pose of " + object + " has come";
    case ZoneCause::kDiscontinuous:
      return "the pose of " + object + " is discontinuous";
    case ZoneCause::kContradicted:
      return "poses of " + object + " contradict each other or the cell";
  }
  return "";
}

}  // namespace clearance
