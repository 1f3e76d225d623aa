// The promise of every result, for assertions at the borders of rooms.
#pragma once

#include "core/distance_result.hpp"

namespace clearance {

// lower <= distance <= upper, and the normal is of unit length; unknown figures (NaN) pass. Bodies
// that no translation separates have no normal, and no upper bound of their depth.
[[nodiscard]] inline bool keeps_promises(const DistanceResult& r) noexcept {
  if (r.lower > r.upper || r.lower > r.distance || r.distance > r.upper) return false;
  return r.normal.isZero(0.0) || is_unit_or_unknown(r.normal);
}

}  // namespace clearance
