#include "limiter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace clearance_control {

Limiter::Limiter(Kind kind, std::vector<JointLimits> limits)
    : kind_(kind),
      limits_(std::move(limits)),
      wanted_(limits_.size()),
      velocities_(limits_.size()),
      commands_(limits_.size()),
      references_(limits_.size()),
      lag_(limits_.size()) {}

void Limiter::start(std::span<const double> commands) noexcept {
  passes_ = false;
  std::ranges::copy(commands, commands_.begin());
  references_ = commands_;
  if (kind_ == Kind::kVelocity)
    velocities_ = commands_;
  else
    std::ranges::fill(velocities_, 0.0);
}

double Limiter::speed_of(const std::vector<double>& velocities) const noexcept {
  double most = 0.0;
  for (std::size_t i = 0; i < velocities.size(); ++i)
    most = std::max(most, std::abs(velocities[i]) / limits_[i].max_velocity);
  return most;
}

// The share of the lag that this update makes up for. It uses half of the deceleration, and leaves
// the other half for references that slow down meanwhile.
double Limiter::share_of_lag(double dt_s) const noexcept {
  double share = 1.0;
  for (std::size_t i = 0; i < lag_.size(); ++i) {
    const double a = 0.5 * limits_[i].deceleration, lag = std::abs(lag_[i]);
    const double half = 0.5 * a * dt_s;
    const double step = dt_s * (std::sqrt(half * half + 2.0 * a * lag) - half);
    if (step < lag) share = std::min(share, step / lag);
  }
  return share;
}

// Fills in the wanted velocities: positions are followed at their own speed, and a lag is made up
// for. Returns true if these velocities reach the references.
bool Limiter::follow(std::span<const double> references, double dt_s) noexcept {
  const bool are_known =
      std::ranges::all_of(references, [](double value) { return std::isfinite(value); });
  double share = are_known ? 1.0 : 0.0;
  if (!are_known) {
    std::ranges::fill(wanted_, 0.0);
  } else if (kind_ == Kind::kVelocity) {
    std::ranges::copy(references, wanted_.begin());
  } else {
    for (std::size_t i = 0; i < lag_.size(); ++i) lag_[i] = references_[i] - commands_[i];
    share = share_of_lag(dt_s);
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
      wanted_[i] = (references[i] - references_[i] + share * lag_[i]) / dt_s;
      references_[i] = references[i];
    }
  }
  return share == 1.0;
}

// The permitted share of the wanted velocities.
double Limiter::factor(const Permitted& permitted) const noexcept {
  const double speed = speed_of(wanted_), scaling = std::clamp(permitted.scaling, 0.0, 1.0);
  double most = std::clamp(permitted.most_speed, 0.0, 1.0);
  if (kind_ == Kind::kPosition) most = std::min(most, scaling);
  const double within = speed > most ? most / speed : 1.0;
  return kind_ == Kind::kPosition ? within : std::min(within, scaling / std::max(speed, 1.0));
}

// The share of the change from the last velocities to the permitted ones that keeps the
// deceleration.
double Limiter::share_of_change(double factor, double dt_s) const noexcept {
  double share = 1.0;
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    const double change = std::abs(factor * wanted_[i] - velocities_[i]);
    const double most = limits_[i].deceleration * dt_s;
    if (change > most) share = std::min(share, most / change);
  }
  return share;
}

void Limiter::update(std::span<const double> references, const Permitted& permitted, double dt_s,
                     std::span<double> commands) noexcept {
  if (dt_s > 0.0) {
    const bool reaches = follow(references, dt_s);
    const double allowed = factor(permitted);
    const bool is_free = reaches && allowed == 1.0;
    const double share = is_free && passes_ ? 1.0 : share_of_change(allowed, dt_s);
    passes_ = is_free && share == 1.0;
    for (std::size_t i = 0; i < commands_.size(); ++i) {
      const double target = allowed * wanted_[i];
      velocities_[i] = share == 1.0 ? target : velocities_[i] + share * (target - velocities_[i]);
      commands_[i] = passes_                    ? references[i]
                     : kind_ == Kind::kPosition ? commands_[i] + dt_s * velocities_[i]
                                                : velocities_[i];
    }
  }
  std::ranges::copy(commands_, commands.begin());
}

}  // namespace clearance_control
