#include "monitor/bodies/displacement.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

using Vec4 = Eigen::Vector4d;

// A quaternion that is of unit length to half of all digits needs neither root nor quotient. The
// next term of the series, 3/8 of the square of its error, is below 2^-53.
Vec4 unit(const Vec4& q) noexcept {
  constexpr double kNearly = 0x1p-26;
  const double off = q.squaredNorm() - 1.0;
  return q * (std::abs(off) < kNearly ? 1.0 - 0.5 * off : 1.0 / q.norm());
}

double turn_at_most(const Vec4& before, const Vec4& after) noexcept {
  if (before == after) return 0.0;
  const Vec4 from = unit(before);
  const Vec4 to = unit(after);
  // |q2 - q1| = 2 sin(theta / 4) has no cancellation. q and -q are the same orientation.
  const double step = std::sqrt(std::min((to - from).squaredNorm(), (to + from).squaredNorm()));
  return rounded_up(2.0 * step) + kTurnRounding;
}

}  // namespace

Motion motion_between(const Pose& before, const Pose& after) noexcept {
  const Vec3 shift = after.position - before.position;
  const bool shifted = before.position != after.position;
  return {.shift = shifted ? rounded_up(shift.norm()) + kShiftUnderflow : 0.0,
          .turn = turn_at_most(before.orientation.coeffs(), after.orientation.coeffs())};
}

double moved_at_most(const Motion& motion, double radius) noexcept {
  const double turning = motion.turn == 0.0 ? 0.0 : motion.turn * radius;  // not 0 * infinity
  return rounded_up(motion.shift + turning);
}

double bend_at_most(const Motion& motion, double radius) noexcept {
  constexpr double kEighth = 1.0 / (8.0 * 0.9 * 0.9);
  return motion.turn == 0.0 ? 0.0 : rounded_up(kEighth * motion.turn * motion.turn * radius);
}

}  // namespace clearance
