// Slows commands of a robot's joints down, and lets them pass where nothing limits them. Pure: no
// clock, no ROS, no DDS. Units: rad or m, s.
//
// Unlimited commands pass to the bit. All others keep the stated deceleration. All joints slow down
// in proportion, so that a robot which is stopped keeps its direction in joint space. Velocities
// that slow down by themselves are followed at once.
//
// Positions have a path, which a limiter that falls behind does not know. So they are held until
// their references are near the commands again.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace clearance_control {

struct JointLimits {
  double max_velocity = 0.0;  // per s
  double deceleration = 0.0;  // per s2: of slowing down, holding and resuming
};

// How fast the joints may be, as shares of their max_velocity and of what was commanded.
struct Permitted {
  // 0: hold. 1: nothing limits. Velocities are multiplied by it; positions follow at no more than
  // this share of max_velocity.
  double scaling = 0.0;
  // No joint exceeds this share of its max_velocity.
  double most_speed = 1.0;
};

class Limiter {
 public:
  // Positions that are farther away than the joints go in this time, and in two updates, are held.
  static constexpr double kCatchUp_s = 0.01;
  enum class Kind { kPosition, kVelocity };

  Limiter(Kind kind, std::vector<JointLimits> limits);

  // Begins with these commands: positions at rest, or velocities.
  void start(std::span<const double> commands) noexcept;
  // Turns the references of this update into commands. A reference that is no number holds. `dt_s`
  // is the time since the last update; without any, the last commands stay.
  void update(std::span<const double> references, const Permitted& permitted, double dt_s,
              std::span<double> commands) noexcept;

  // Returns true if the last commands were the references.
  [[nodiscard]] bool passes() const noexcept { return passes_; }
  // Returns true if positions are held because the references are away from the commands.
  [[nodiscard]] bool is_away() const noexcept { return is_away_; }
  // Returns the largest |velocity| / max_velocity of the last commands.
  [[nodiscard]] double speed() const noexcept { return speed_of(velocities_); }

 private:
  [[nodiscard]] double speed_of(const std::vector<double>& velocities) const noexcept;
  [[nodiscard]] double share_of_lag(double dt_s) const noexcept;
  [[nodiscard]] bool are_away(std::span<const double> references, double dt_s) const noexcept;
  void slow_down_to(std::span<const double> references) noexcept;
  bool follow(std::span<const double> references, double dt_s) noexcept;
  [[nodiscard]] double factor(const Permitted& permitted) const noexcept;
  [[nodiscard]] double share_of_change(double factor, double dt_s) const noexcept;

  Kind kind_;
  std::vector<JointLimits> limits_;
  bool passes_ = false, is_away_ = false;
  std::vector<double> wanted_;                 // velocities that reach the references
  std::vector<double> velocities_, commands_;  // of the last update
  // Of positions: the last references, and how far the commands were behind them.
  std::vector<double> references_, lag_;
};

}  // namespace clearance_control
