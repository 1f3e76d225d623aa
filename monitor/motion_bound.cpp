#include "monitor/motion_bound.hpp"

#include <algorithm>

#include "monitor/rounding.hpp"

namespace clearance {
namespace {

using Vec4 = Eigen::Vector4d;

// Four squares, a root and a division leave each of the two unit quaternions within 2^-51 of the
// exact one; their difference within 2^-50, and twice that within 2^-49.
constexpr double kTurnError = 0x1p-48;
// Squares of differences below 1e-154 underflow; their norm is then below this.
constexpr double kUnderflow = 1e-150;

double turn_at_most(const Vec4& before, const Vec4& after) noexcept {
  if (before == after) return 0.0;
  const Vec4 from = before / before.norm();
  const Vec4 to = after / after.norm();
  // |q2 - q1| = 2 sin(theta / 4): free of cancellation. q and -q are the same orientation.
  const double step = std::min((to - from).norm(), (to + from).norm());
  return rounded_up(2.0 * step) + kTurnError;
}

}  // namespace

Motion motion_between(const Pose& before, const Pose& after) noexcept {
  const Vec3 shift = after.position - before.position;
  const bool shifted = before.position != after.position;
  return {.shift = shifted ? rounded_up(shift.norm()) + kUnderflow : 0.0,
          .turn = turn_at_most(before.orientation.coeffs(), after.orientation.coeffs())};
}

double moved_at_most(const Motion& motion, double reach) noexcept {
  const double turned = motion.turn == 0.0 ? 0.0 : motion.turn * reach;  // not 0 * infinity
  return rounded_up(motion.shift + turned);
}

}  // namespace clearance
