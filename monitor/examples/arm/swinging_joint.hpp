// A simulated machine: one joint that swings between two places. It takes a reaction until a
// command acts, and brakes as the cell says that it does. Without a command for as long as the
// reaction, it stops.
#pragma once

#include <cstddef>
#include <deque>

#include "config/scene/stopping.hpp"

namespace clearance::stops {

struct SwingingJointOptions {
  double from = 0.0, to = 0.0;  // rad or m
  double full_speed = 0.0;      // per second, above 0
  double acceleration = 0.0;    // per second squared, above 0; of all but braking
  double reaction = 0.0;        // s: from a command until it acts
  JointStop stop;
};

class SwingingJoint {
 public:
  explicit SwingingJoint(const SwingingJointOptions& options);

  // From the reaction on, the joint is to be no faster than this.
  void command(double speed);
  void advance(double seconds);

  [[nodiscard]] double position() const noexcept { return position_; }
  [[nodiscard]] double velocity() const noexcept { return velocity_; }
  // Motions from one place to the other that it has ended.
  [[nodiscard]] std::size_t strokes() const noexcept { return strokes_; }
  // No command holds it back.
  [[nodiscard]] bool is_at_full_speed() const noexcept { return most_ >= options_.full_speed; }

 private:
  struct Command {
    double acts_at, speed;
  };
  // Braking starts with the deceleration that its speed has in the table, and keeps it.
  void brake(double seconds);
  [[nodiscard]] double left() const noexcept;  // until the end of the present motion

  SwingingJointOptions options_;
  std::deque<Command> commands_;
  double time_ = 0.0, position_, velocity_ = 0.0;
  double told_at_ = 0.0;       // the last command
  double most_ = 0.0;          // speed that is allowed now
  double deceleration_ = 0.0;  // of the brakes; 0: they do not act
  double side_;                // of the place where it goes: 1 or -1
  std::size_t strokes_ = 0;
};

}  // namespace clearance::stops
