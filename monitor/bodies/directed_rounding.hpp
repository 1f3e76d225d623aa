// Directed rounding without the processor's rounding mode: a step outwards that exceeds the
// rounding error.
//
// One correctly rounded operation has an error of at most |x| * 2^-53. The step of 2^-50 covers
// itself and the last six operations that led to x, if none of them cancelled. An infinity stays
// unchanged in the direction of its sign, and is NaN in the other.
#pragma once

#include <cmath>

namespace clearance {

[[nodiscard]] inline double rounded_up(double x) noexcept { return x + std::abs(x) * 0x1p-50; }
[[nodiscard]] inline double rounded_down(double x) noexcept { return x - std::abs(x) * 0x1p-50; }

// The same for a figure that may be infinite, and stays so.
[[nodiscard]] inline double rounded_down_if_finite(double x) noexcept {
  return std::isinf(x) ? x : rounded_down(x);
}

// The path length of a point at the distance `arm` under a rotation by `turn`, rad. Here 0 *
// infinity is 0: without rotation, points at infinity do not move either.
[[nodiscard]] inline double swept(double turn, double arm) noexcept {
  return turn == 0.0 ? 0.0 : turn * arm;
}

}  // namespace clearance
