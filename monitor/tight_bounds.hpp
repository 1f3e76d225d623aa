// Bounds that differ by no more than rounding, so that they stand for a distance.
#pragma once

namespace clearance {

// m. The bounds of a query that has converged are as near as this. Those of its pair may be farther
// apart: the place of an object may have an error, or the object may have moved since its stamp.
inline constexpr double kTightGap = 2e-9;

// Infinite bounds that are equal are tight: no difference of them is a number.
[[nodiscard]] inline bool are_tight(double lower, double upper) noexcept {
  return !(upper - lower > kTightGap);
}

}  // namespace clearance
