#include "config/scene/stopping.hpp"

#include <algorithm>
#include <cmath>

namespace clearance {
namespace {

// Makes up for the rounding of a few products.
constexpr double kRoundedUp = 1.0 + 0x1p-48;

}  // namespace

// Rows of several loads have one speed: the worst of them is its point.
JointStop JointStop::by_table(std::vector<StopPoint> points) {
  std::ranges::sort(points, {}, &StopPoint::speed);
  JointStop stop;
  StopPoint worst;
  for (const StopPoint& point : points) {
    worst = {point.speed, std::max(worst.distance, point.distance),
             std::max(worst.time, point.time)};
    if (stop.points_.empty() || stop.points_.back().speed < point.speed)
      stop.points_.push_back(worst);
    else
      stop.points_.back() = worst;
  }
  return stop;
}

JointStop JointStop::by_deceleration(double deceleration) {
  JointStop stop;
  stop.deceleration_ = deceleration;
  return stop;
}

JointStop JointStop::by_time(double time) {
  JointStop stop;
  stop.time_ = time;
  return stop;
}

double JointStop::longest(double speed) const noexcept {
  if (!(speed > 0.0)) return 0.0;
  if (deceleration_ > 0.0 || points_.empty()) return kRoundedUp * (distance(speed) / speed);
  double longest = 0.0;
  for (const StopPoint& point : points_) {
    longest = std::max(longest, point.distance / point.speed);
    if (point.speed >= speed) return kRoundedUp * longest;
  }
  return kRoundedUp * std::max(longest, distance(speed) / speed);
}

double JointStop::distance(double speed) const noexcept {
  if (!(speed > 0.0)) return 0.0;
  if (deceleration_ > 0.0) return kRoundedUp * (0.5 * speed * speed / deceleration_);
  if (points_.empty()) return kRoundedUp * (speed * time_);
  const auto next = std::ranges::lower_bound(points_, speed, {}, &StopPoint::speed);
  if (next == points_.end()) {
    const double share = speed / points_.back().speed;
    return kRoundedUp * (points_.back().distance * share * share);
  }
  double quotient = next->distance / next->speed;
  if (next != points_.begin())
    quotient = std::max(quotient, (next - 1)->distance / (next - 1)->speed);
  return std::min(next->distance, kRoundedUp * (speed * quotient));
}

double JointStop::time(double speed) const noexcept {
  if (!(speed > 0.0)) return 0.0;
  if (deceleration_ > 0.0) return kRoundedUp * (speed / deceleration_);
  if (points_.empty()) return time_;
  const auto next = std::ranges::lower_bound(points_, speed, {}, &StopPoint::speed);
  if (next != points_.end()) return next->time;
  return kRoundedUp * (points_.back().time * (speed / points_.back().speed));
}

}  // namespace clearance
