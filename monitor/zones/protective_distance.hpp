// The protective separation distance S_p of ISO/TS 15066 as a function of the robot's speed, and
// the largest speed that keeps it. README.md here derives both.
#pragma once

#include "config/scene/separation.hpp"

namespace clearance {

// Upper bounds of the motion of a person and a robot towards each other.
struct Approach {
  double human_speed = 0.0;         // m/s
  double human_acceleration = 0.0;  // m/s2
  double robot_speed = 0.0;         // m/s
  double human_age = 0.0;           // s: the age of the pose that the distance rests on
  double robot_age = 0.0;
  double report_delay = 0.0;  // s: the measured part of T_r; 0: none is
  // The path, m, that the distance has already lost because the pose is late. S_p then counts the
  // rest of the path since the pose, if any is left.
  double human_counted = 0.0, robot_counted = 0.0;
};

// The terms of S_p, m, rounded up. `sum` is C + Z_d + Z_r more than the sum of the others.
struct ProtectiveDistance {
  double human = 0.0;     // S_h: the person's path until the robot stands
  double robot = 0.0;     // S_r: the robot's path until it brakes
  double stopping = 0.0;  // S_s: the robot's path from then until it stands
  double sum = 0.0;       // S_p
};

// S_p with the robot at `speed`, m/s, from now on. It is never smaller for a larger speed, to the
// bit.
[[nodiscard]] ProtectiveDistance protective_distance(const Separation& terms,
                                                     const Approach& approach,
                                                     double speed) noexcept;

// The largest speed of the robot, m/s, for which `distance`, m, is enough. 0: the distance is not
// even enough for a robot that stands. Infinity: the speed does not matter. If the result is not 0,
// protective_distance() at it, and at any lower speed, is at most `distance`.
[[nodiscard]] double largest_speed(const Separation& terms, const Approach& approach,
                                   double distance) noexcept;

}  // namespace clearance
