// Bounds that differ by no more than rounding, so that they stand for a distance.
#pragma once

namespace clearance {

// The bounds of a converged query differ by at most this, m. The bounds of its pair may differ by
// more: the place of an object may have an error, or the object may have moved since its stamp.
inline constexpr double kTightGap = 2e-9;

// Equal infinite bounds are tight, although their difference is NaN.
[[nodiscard]] inline bool are_tight(double lower, double upper) noexcept {
  return !(upper - lower > kTightGap);
}

}  // namespace clearance
