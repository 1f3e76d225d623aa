// A robot that moves towards goals of its own, and obeys the scaling of each report: the command
// holds after the reaction. It slows down as in a stop that begins then, until it has reached the
// share. A robot that leaves its path when it brakes does not slow down: below 1 it stops.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <vector>

#include "config/scene/scene.hpp"
#include "tests/monitor/ask/arms_that_stop.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {

class ObeyingRobot {
 public:
  static constexpr double kStep = 1e-3;  // s: a tick

  // `age`: of the states that reports read, in ticks. `late`: of its commands, beyond what is
  // stated.
  ObeyingRobot(const DrawnArms& arms, std::uint32_t robot, std::size_t age, std::size_t late,
               std::uint64_t seed)
      : robot_(arms.scene.robots[robot]), age_(age), random_(seed) {
    const Scene& scene = arms.scene;
    const RobotStops& stops = robot_.stopping;
    reaction_ = static_cast<std::size_t>(std::lround(stops.reaction / kStep)) + late;
    states_stops_ = random_.chance(0.5);
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
      if (!moves(scene, robot_, j)) continue;
      Joint joint{.of = &scene.variables[robot_.joints[j].variable],
                  .stop = &arms.machines[robot][j]};
      joint.variable = robot_.joints[j].variable;
      if (!stops.max_accelerations.empty()) joint.acceleration = stops.max_accelerations[j];
      accelerates_ = joint.acceleration < kInfinity;
      joints_.push_back(joint);
    }
  }

  // Begins anew: at rest, or where nothing states accelerations with a speed that stays.
  void begin() {
    state_ = {};
    state_.scaling = 1.0;
    for (Joint& joint : joints_) {
      joint.position = random_.uniform(least(joint), most(joint));
      joint.goal = joint.position;
      const bool rests = accelerates_ || is_small(joint);
      joint.velocity = rests ? 0.0 : 0.8 * joint.of->max_speed * random_.uniform(-1.0, 1.0);
    }
    commands_.assign(reaction_, Command{.cap = kInfinity, .reported = 0});
    braking_ = stops_ = false;
    past_.clear();
    for (std::size_t k = age_; k > 0; --k) note(-kStep * static_cast<double>(k));
    note(0.0);
  }

  struct Said {
    std::vector<double> positions, velocities;  // by joint
    double scaling = 0.0;                       // of its own profile
    bool stopping = false;                      // stated: its brakes act until it stands
  };
  // What the robot says at this tick: `age` ticks old.
  [[nodiscard]] const Said& said() const { return past_.front(); }
  [[nodiscard]] std::uint32_t variable(std::size_t joint) const { return joints_[joint].variable; }
  [[nodiscard]] double position(std::size_t joint) const { return joints_[joint].position; }
  [[nodiscard]] std::size_t joints() const { return joints_.size(); }
  [[nodiscard]] bool stands() const { return state_.scaling == 0.0; }
  [[nodiscard]] const Robot& robot() const { return robot_; }
  // A joint comes to its limit, and nothing states that the robot may turn.
  [[nodiscard]] bool is_at_its_end() const {
    return !accelerates_ && std::ranges::any_of(joints_, [](const Joint& joint) {
      return joint.position < joint.of->lower || joint.position > joint.of->upper;
    });
  }

  // One tick on, after a report with this scaling.
  void obey(double scaling) {
    const bool may_grow = scaling >= 1.0 && accelerates_;
    double cap = may_grow ? kInfinity : scaling * said().scaling;
    if (said().stopping) cap = 0.0;  // such a report admits the stop, and no motion after it
    commands_.push_back({.cap = cap, .reported = tick_});
    const Command command = commands_.front();
    commands_.pop_front();
    ++tick_;
    if (robot_.stopping.keeps_path) {
      // A stop that it states goes on until it stands, whatever the commands are.
      stops_ = states_stops_ && !stands() && (stops_ || command.cap == 0.0);
      follow(stops_ ? 0.0 : command.cap);
    } else {
      leave_path(command);
    }
    note(0.0);
  }

 private:
  struct Joint {
    const JointVariable* of = nullptr;
    const MachineStop* stop = nullptr;
    std::uint32_t variable = 0;
    double acceleration = kInfinity;
    double position = 0.0, velocity = 0.0;  // of its own profile: before it is scaled
    double goal = 0.0;
    double from = 0.0, power = 1.0, distance = 0.0, time = 0.0;  // while it brakes by itself
  };
  struct Command {
    double cap = 0.0;
    std::size_t reported = 0;  // the tick of the report
  };
  // A stop in proportion, in seconds of the robot's own profile.
  struct Braking {
    double distance = 0.0, time = 0.0, power = 1.0, elapsed = 0.0;
    [[nodiscard]] double went(double t) const { return distance * share_gone(t, time, power); }
    [[nodiscard]] double speed(double t) const {
      return t >= time ? 0.0 : distance * power / time * std::pow(1.0 - t / time, power - 1.0);
    }
    // When it has slowed down to this.
    [[nodiscard]] double slowed_to(double speed) const {
      if (power <= 1.0 + 1e-9) return time;
      const double share = speed * time / (distance * power);
      return time * (1.0 - std::pow(std::min(1.0, share), 1.0 / (power - 1.0)));
    }
  };

  static bool is_small(const Joint& joint) { return joint.of->upper - joint.of->lower < 0.2; }
  static double least(const Joint& joint) { return 0.8 * std::max(joint.of->lower, -2.5); }
  static double most(const Joint& joint) { return 0.8 * std::min(joint.of->upper, 2.5); }

  void note(double before) {
    Said said{.positions = {},
              .velocities = {},
              .scaling = state_.scaling,
              .stopping = states_stops_ && (robot_.stopping.keeps_path ? stops_ : braking_)};
    for (const Joint& joint : joints_) {
      said.positions.push_back(joint.position + before * joint.velocity);
      said.velocities.push_back(state_.scaling * joint.velocity);
    }
    past_.push_back(said);
    if (past_.size() > age_ + 1) past_.pop_front();
  }

  void follow(double cap) {
    if (state_.scaling <= cap) {
      braking_ = false;
      const double before = state_.scaling;
      const double grown = accelerates_ ? before + kStep * growth() : before;
      state_.scaling = std::min({1.0, cap, grown});
      go_on(0.5 * (before + state_.scaling) * kStep);
      return;
    }
    if (!braking_) brake();
    const double from = braking_law_.elapsed, to = from + kStep;
    const double reached = std::clamp(braking_law_.slowed_to(cap), from, to);
    go_on(braking_law_.went(reached) - braking_law_.went(from) + cap * (to - reached));
    braking_law_.elapsed = to;
    const double speed = braking_law_.speed(to);
    braking_ = speed > cap || cap == 0.0;
    state_.scaling = std::max(cap, speed);
  }

  void brake() {
    braking_ = true;
    double in_proportion = 0.0, longest = 0.0;
    for (const Joint& joint : joints_) {
      const double speed = std::abs(state_.scaling * joint.velocity);
      if (!(speed > 0.0)) continue;
      in_proportion = std::max(in_proportion, joint.stop->distance(speed) / speed);
      longest = std::max(longest, joint.stop->time(speed));
    }
    const double share = random_.chance(0.6) ? 1.0 : random_.uniform(0.3, 1.0);
    const double time = std::max(longest, 1e-9);
    const double lasts = std::clamp(share * in_proportion, 1e-10, time);
    braking_law_ = {.distance = state_.scaling * lasts,
                    .time = time,
                    .power = random_.uniform(1.0, time / lasts)};
  }

  // Seconds of its own profile: a joint's speed changes by half of what is stated.
  void go_on(double seconds) {
    for (Joint& joint : joints_) {
      double change = 0.0;
      if (accelerates_ && !is_small(joint) && seconds > 0.0) {
        if (std::abs(joint.goal - joint.position) < 0.02)
          joint.goal = random_.uniform(least(joint), most(joint));
        const double left = joint.goal - joint.position;
        const double half = 0.5 * joint.acceleration;
        const double wanted = std::copysign(
            std::min(0.8 * joint.of->max_speed, std::sqrt(std::abs(left) * half)), left);
        change = std::clamp(wanted - joint.velocity, -half * seconds, half * seconds);
      }
      joint.position += (joint.velocity + 0.5 * change) * seconds;
      joint.velocity += change;
    }
  }
  // Of the scaling, per second: the other half of the accelerations.
  [[nodiscard]] double growth() const {
    double most = 100.0;
    for (const Joint& joint : joints_)
      if (joint.velocity != 0.0)
        most = std::min(most, 0.45 * joint.acceleration / std::abs(joint.velocity));
    return most;
  }

  // Each joint brakes by itself, until all stand.
  void leave_path(const Command& command) {
    if (!braking_ && state_.scaling <= command.cap) {
      go_on(state_.scaling * kStep);
      return;
    }
    if (stands()) {
      // Since then, a report has admitted that it moves.
      if (!(accelerates_ && command.cap == kInfinity && command.reported >= stood_ + age_)) return;
      braking_ = false;
      state_.scaling = 1.0;
      go_on(kStep);
      return;
    }
    if (!braking_) brake_by_joint();
    elapsed_ += kStep;
    bool all_stand = true;
    for (Joint& joint : joints_) {
      if (joint.time == 0.0) continue;
      const double left = std::max(0.0, 1.0 - elapsed_ / joint.time);
      joint.position = joint.from + joint.distance * share_gone(elapsed_, joint.time, joint.power);
      joint.velocity =
          left > 0.0 ? joint.distance * joint.power / joint.time * std::pow(left, joint.power - 1.0)
                     : 0.0;
      all_stand = all_stand && left == 0.0;
    }
    if (!all_stand) return;
    state_.scaling = 0.0;
    stood_ = tick_;
    for (Joint& joint : joints_) joint.goal = joint.position;
  }
  void brake_by_joint() {
    braking_ = true;
    elapsed_ = 0.0;
    for (Joint& joint : joints_) {
      const double speed = std::abs(joint.velocity);
      const double share = random_.chance(0.6) ? 1.0 : random_.uniform(0.3, 1.0);
      joint.from = joint.position;
      joint.time = joint.stop->time(speed);
      joint.distance = std::copysign(share * joint.stop->distance(speed), joint.velocity);
      const double steepest = speed * joint.time / std::max(1e-12, std::abs(joint.distance));
      joint.power = random_.uniform(1.0, std::max(1.0, steepest));
    }
  }

  const Robot& robot_;
  std::size_t age_, reaction_ = 0, tick_ = 0, stood_ = 0;  // ticks
  Random random_;
  std::vector<Joint> joints_;
  struct {
    double scaling = 1.0;  // of its own profile
  } state_;
  bool accelerates_ = false, braking_ = false;
  bool states_stops_ = false, stops_ = false;  // it states that a stop is in progress
  Braking braking_law_;
  double elapsed_ = 0.0;  // s: since the joints brake by themselves
  std::deque<Command> commands_;
  std::deque<Said> past_;
};

}  // namespace clearance::test
