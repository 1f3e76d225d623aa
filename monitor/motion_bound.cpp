#include "monitor/motion_bound.hpp"

#include <algorithm>

#include "monitor/rounding.hpp"

namespace clearance {
namespace {

using Vec4 = Eigen::Vector4d;

void note_turn(const Vec4& before, const Vec4& after, Motion& motion) noexcept {
  if (before == after) return;
  const Vec4 from = before / before.norm();
  const Vec4 to = after / after.norm();
  // |q2 - q1| = 2 sin(theta / 4): free of cancellation. q and -q are the same orientation.
  const double ahead = (to - from).norm(), about = (to + from).norm();
  motion.turn = rounded_up(2.0 * std::min(ahead, about)) + kTurnRounding;
  // The vector part of `to` times the conjugate of `from`.
  const Vec3 v =
      from.w() * to.head<3>() - to.w() * from.head<3>() - to.head<3>().cross(from.head<3>());
  motion.turning = (ahead <= about ? 2.0 : -2.0) * v;
}

}  // namespace

Motion motion_between(const Pose& before, const Pose& after) noexcept {
  Motion motion;
  motion.way = after.position - before.position;
  const bool shifted = before.position != after.position;
  motion.shift = shifted ? rounded_up(motion.way.norm()) + kShiftUnderflow : 0.0;
  note_turn(before.orientation.coeffs(), after.orientation.coeffs(), motion);
  return motion;
}

double moved_at_most(const Motion& motion, double reach) noexcept {
  const double turned = motion.turn == 0.0 ? 0.0 : motion.turn * reach;  // not 0 * infinity
  return rounded_up(motion.shift + turned);
}

}  // namespace clearance
