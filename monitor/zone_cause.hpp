// How every program says why a zone is active.
#pragma once

#include <string>

#include "monitor/report.hpp"

namespace clearance {

// "by distance", "poses of hand are late". `object`: the name of ZoneReport::cause_object. Empty
// while the zone is not active.
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
