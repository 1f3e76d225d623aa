#include "monitor/inputs/mean_twist.hpp"

#include <cmath>

namespace clearance {

Twist mean_twist(const Pose& from, const Pose& to, double seconds) noexcept {
  const Eigen::Quaterniond turn =
      to.orientation.normalized() * from.orientation.normalized().conjugate();
  const double sine = turn.vec().norm();
  const double angle = 2.0 * std::atan2(sine, std::abs(turn.w()));
  const double per_sine = sine > 0.0 ? std::copysign(angle / sine, turn.w()) / seconds : 0.0;
  return {.linear = (to.position - from.position) / seconds, .angular = turn.vec() * per_sine};
}

}  // namespace clearance
