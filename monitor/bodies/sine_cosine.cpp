// Reduces the angle to [-pi/4, pi/4] (Cody and Waite), then evaluates the minimax polynomials of
// fdlibm's kernels (Sun Microsystems, 1993).
#include "monitor/bodies/sine_cosine.hpp"

#include <cstdint>

namespace clearance {
namespace {

// pi / 2 as the sum of three numbers. The first two have 33 bits, so their products with an integer
// below 2^20 are exact.
constexpr double kHalfPi1 = 1.57079632673412561417e+00;
constexpr double kHalfPi2 = 6.07710050630396597660e-11;
constexpr double kHalfPi3 = 2.02226624879595063154e-21;
constexpr double kPerHalfPi = 6.36619772367581382433e-01;
// Adding and subtracting this rounds to an integer, in the rounding mode to nearest.
constexpr double kRounder = 0x1.8p52;

// Both are accurate up to rounding for |x| <= pi/4.
double sine_of(double x) noexcept {
  constexpr double kS1 = -1.66666666666666324348e-01, kS2 = 8.33333333332248946124e-03,
                   kS3 = -1.98412698298579493134e-04, kS4 = 2.75573137070700676789e-06,
                   kS5 = -2.50507602534068634195e-08, kS6 = 1.58969099521155010221e-10;
  const double z = x * x;
  return x + x * z * (kS1 + z * (kS2 + z * (kS3 + z * (kS4 + z * (kS5 + z * kS6)))));
}

double cosine_of(double x) noexcept {
  constexpr double kC1 = 4.16666666666666019037e-02, kC2 = -1.38888888888741095749e-03,
                   kC3 = 2.48015872894767294178e-05, kC4 = -2.75573143513906633035e-07,
                   kC5 = 2.08757232129817482790e-09, kC6 = -1.13596475577881948265e-11;
  const double z = x * x;
  const double rest = z * z * (kC1 + z * (kC2 + z * (kC3 + z * (kC4 + z * (kC5 + z * kC6)))));
  return 1.0 - (0.5 * z - rest);
}

}  // namespace

// The first difference is exact. The second and the third round once each, 2^-53 in all, since the
// result is below 1.
SineCosine sine_cosine(double angle) noexcept {
  const double quarters = (angle * kPerHalfPi + kRounder) - kRounder;
  const double x = ((angle - quarters * kHalfPi1) - quarters * kHalfPi2) - quarters * kHalfPi3;
  const double sine = sine_of(x), cosine = cosine_of(x);
  switch (static_cast<std::int64_t>(quarters) & 3) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

}  // namespace clearance
