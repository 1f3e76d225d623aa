#include "monitor/sensors/past_pose.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/bodies/tracked_object.hpp"

namespace clearance {
namespace {

// The rounding of a product of two poses, relative to the lengths that take part.
constexpr double kComposed = 0x1p-48;

}  // namespace

double path_within(double speed, std::int64_t within_ns) noexcept {
  return within_ns > 0 ? rounded_up(speed * 1e-9 * static_cast<double>(within_ns)) : 0.0;
}

double excess(double time_s, double speed, double mean) noexcept {
  return (std::max(0.0, std::abs(mean) - speed) + 0x1p-48 * speed) * time_s;
}

double PastPose::error(double radius) const noexcept {
  return rounded_up(shift_error + turn_error * radius);
}

bool PastPose::is_sound() const noexcept {
  return !known || (is_usable(world_from_body) && shift_error >= 0.0 && turn_error >= 0.0);
}

PastPose carried(const PastPose& parent, const Pose& parent_from_child, double shift_error,
                 double turn_error) noexcept {
  const double arm = parent_from_child.position.norm();
  PastPose child = parent;
  child.world_from_body = compose(parent.world_from_body, parent_from_child);
  child.world_from_body.orientation.normalize();
  const double rounding = kComposed * (arm + parent.world_from_body.position.norm());
  child.shift_error =
      rounded_up(parent.shift_error + parent.turn_error * arm + shift_error + rounding);
  child.turn_error = rounded_up(parent.turn_error + turn_error + kComposed);
  return child;
}

// The value is within speed times the time of both ends, and the line has come mean times the time.
double deviation(double before_s, double after_s, double speed, double mean) noexcept {
  if (before_s <= 0.0 || after_s <= 0.0) return 0.0;
  const double u = std::min(std::abs(mean), speed);
  const double ahead = std::min(before_s * (speed - u), after_s * (speed + u));
  const double behind = std::min(before_s * (speed + u), after_s * (speed - u));
  // The differences above lose digits where both speeds are nearly equal.
  return rounded_up(std::max(ahead, behind) + excess(before_s + after_s, speed, mean));
}

// With x between a and b, and p on the line at its time: |x - p| is no more than |x - a| + |a - p|.
// By Stewart's theorem, its square is no more than before_s after_s (speed^2 - mean^2).
double deviation_in_space(double before_s, double after_s, double speed, double mean) noexcept {
  if (before_s <= 0.0 || after_s <= 0.0) return 0.0;
  const double u = std::min(std::abs(mean), speed);
  const double square = before_s * after_s * (speed + u) * (speed - u + 0x1p-48 * speed);
  return std::min(deviation_of_turn(before_s, after_s, speed, mean),
                  rounded_up(std::sqrt(square) + excess(before_s + after_s, speed, mean)));
}

double deviation_of_turn(double before_s, double after_s, double speed, double mean) noexcept {
  if (before_s <= 0.0 || after_s <= 0.0) return 0.0;
  const double u = std::min(std::abs(mean), speed);
  return rounded_up((speed + u) * std::min(before_s, after_s) +
                    excess(before_s + after_s, speed, mean));
}

}  // namespace clearance
