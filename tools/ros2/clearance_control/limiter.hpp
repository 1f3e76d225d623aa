// Slows commands of a robot's joints down, and lets them pass where nothing limits them. Pure: no
// clock, no ROS, no DDS. Units: rad or m, s.
//
// Unlimited commands pass to the bit. All others keep the stated deceleration, and all joints slow
// down in proportion, so that a robot which is stopped keeps its direction in joint space.
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
  enum class Kind { kPosition, kVelocity };

  Limiter(Kind kind, std::vector<JointLimits> limits);

  // Begins with these commands: positions at rest, or velocities.
  void start(std::span<const double> commands) noexcept;
  // Turns the references of this update into commands. A reference that is no number holds. `dt_s`
  // is the time since the last update; without any, the last commands stay.
  void update(std::span<const double> references, const Permitted& permitted, double dt_s,
              std::span<double> commands) noexcept;

  // The commands of the last update were the references.
  [[nodiscard]] bool passes() const noexcept { return passes_; }
  // The largest share of its max_velocity that a joint was told.
  [[nodiscard]] double speed() const noexcept { return speed_of(velocities_); }

 private:
  [[nodiscard]] double speed_of(const std::vector<double>& velocities) const noexcept;
  [[nodiscard]] double share_of_lag(double dt_s) const noexcept;
  bool follow(std::span<const double> references, double dt_s) noexcept;
  [[nodiscard]] double factor(const Permitted& permitted) const noexcept;
  [[nodiscard]] double share_of_change(double factor, double dt_s) const noexcept;

  Kind kind_;
  std::vector<JointLimits> limits_;
  bool passes_ = false;
  std::vector<double> wanted_;                 // velocities that reach the references
  std::vector<double> velocities_, commands_;  // of the last update
  // Of positions: the last references, and how far the commands were behind them.
  std::vector<double> references_, lag_;
};

}  // namespace clearance_control
