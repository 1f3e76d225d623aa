// Directed rounding without the processor's rounding mode: a step outward by more than the error.
//
// One correctly rounded operation is off by at most |x| * 2^-53. So 2^-50 covers the step itself
// and the last six operations that led to x, if none of them cancelled. An infinity stays what it
// is.
#pragma once

#include <cmath>

namespace clearance {

[[nodiscard]] inline double rounded_up(double x) noexcept { return x + std::abs(x) * 0x1p-50; }
[[nodiscard]] inline double rounded_down(double x) noexcept { return x - std::abs(x) * 0x1p-50; }

// How far a turn, rad, moves a point at the distance `arm`. 0 * infinity means 0 here: a body that
// does not turn does not move its far points either.
[[nodiscard]] inline double swept(double turn, double arm) noexcept {
  return turn == 0.0 ? 0.0 : turn * arm;
}

}  // namespace clearance
