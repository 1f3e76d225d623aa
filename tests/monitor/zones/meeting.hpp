// Zones with `separation` in the tick: two balls, one of them a person and the other a robot.
#pragma once

#include <cstdint>
#include <optional>

#include "monitor/tick/monitor.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance::test {

inline constexpr double kHumanRadius = 0.2, kRobotRadius = 0.1;

// A reaction time of 0.1 s, and a deceleration of 4 m/s2, measured at 1 m/s.
inline Separation usual_terms() {
  Separation terms;
  terms.reaction_time_ns = 100'000'000;
  terms.stopping_time_ns = 250'000'000;
  terms.stopping_distance = 0.125;
  terms.stopping_speed = 1.0;
  return terms;
}

// A person (0) and a robot (1) with at most 2 m/s. The person is the first object of the pair.
struct Meeting {
  explicit Meeting(Separation terms = usual_terms(), double robot_max_speed = 2.0) {
    Object robot = moving("robot", {ball(kRobotRadius)});
    robot.max_speed = robot_max_speed;
    scene = cell_of({moving("person", {ball(kHumanRadius)}), robot});
    scene.pairs[0].publish = true;
    scene.zones.push_back(zone_over(scene, 0.3, 0.4));
    terms.human_is_first = {1};
    scene.zones[0].separation = terms;
  }
  void begin() { monitor.emplace(scene); }
  std::int64_t delay_ns = 0;  // that ticks are told

  // The person is at x on a line from the robot at the origin. Both velocities are along that line.
  const PairSeparation& tick(double human_x, double human_speed, double robot_speed,
                             std::int64_t human_age_ns = 0, std::int64_t robot_age_ns = 0) {
    if (!monitor) begin();
    now += kTick;
    PoseSample human = sample(0, at(human_x, 0, 0), now - human_age_ns);
    human.has_twist = true;
    human.twist.linear = {human_speed, 0, 0};
    PoseSample robot = sample(1, at(0, 0, 0), now - robot_age_ns);
    robot.has_twist = true;
    robot.twist.linear = {robot_speed, 0, 0};
    robot.twist.angular = robot_turn;
    const PoseSample both[] = {human, robot};
    const TickTime time(now, 0, delay_ns);
    return (report = &monitor->tick(both, time))->separated_pairs[0];
  }
  // No input arrives for this time.
  const PairSeparation& wait(std::int64_t ns) {
    return (report = &monitor->tick({}, now += ns))->separated_pairs[0];
  }

  Scene scene;
  std::optional<Monitor> monitor;
  const Report* report = nullptr;
  Vec3 robot_turn = Vec3::Zero();
  std::int64_t now = kStart;
};

}  // namespace clearance::test
