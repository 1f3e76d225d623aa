#include "monitor/examples/arm/swinging_joint.hpp"

#include <algorithm>
#include <cmath>

namespace clearance::stops {

SwingingJoint::SwingingJoint(const SwingingJointOptions& options)
    : options_(options), position_(options.from), side_(options.to < options.from ? -1.0 : 1.0) {}

double SwingingJoint::left() const noexcept {
  const double end = side_ * (options_.to - options_.from) > 0.0 ? options_.to : options_.from;
  return side_ * (end - position_);
}

void SwingingJoint::command(double speed) {
  commands_.push_back({time_ + options_.reaction, speed});
  told_at_ = time_;
}

void SwingingJoint::brake(double seconds) {
  const double speed = std::abs(velocity_);
  if (deceleration_ == 0.0) {
    // At a constant deceleration, it goes half as far as without brakes.
    const double time =
        std::min(options_.stop.time(speed), 2.0 * options_.stop.distance(speed) / speed);
    deceleration_ = speed / time;
  }
  velocity_ = std::copysign(std::max(most_, speed - deceleration_ * seconds), velocity_);
}

void SwingingJoint::advance(double seconds) {
  const bool is_silent = time_ - told_at_ > options_.reaction;
  time_ += seconds;
  while (!commands_.empty() && commands_.front().acts_at <= time_) {
    most_ = commands_.front().speed;
    commands_.pop_front();
  }
  if (is_silent) most_ = 0.0;
  const double before = velocity_;
  if (std::abs(velocity_) > most_) {
    brake(seconds);
  } else {
    deceleration_ = 0.0;
    // From here it can still come to rest at its end.
    const double rest = std::max(0.0, left());
    const double wanted = side_ * std::min({most_, options_.full_speed,
                                            std::sqrt(2.0 * options_.acceleration * rest)});
    const double change = options_.acceleration * seconds;
    velocity_ += std::clamp(wanted - velocity_, -change, change);
  }
  position_ += 0.5 * (before + velocity_) * seconds;
  constexpr double kThere = 1e-3;  // rad or m
  if (left() > kThere) return;
  side_ = -side_;
  ++strokes_;
}

}  // namespace clearance::stops
