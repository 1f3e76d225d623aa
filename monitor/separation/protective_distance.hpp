// The protective separation distance S_p of ISO/TS 15066 as a function of the robot's speed, and
// the largest speed that keeps it. README.md here derives both.
#pragma once

#include "config/scene/separation.hpp"

namespace clearance {

// How people and robot move, in the direction of each other, at most.
struct Approach {
  double human_speed = 0.0;         // m/s
  double human_acceleration = 0.0;  // m/s2
  double robot_speed = 0.0;         // m/s
  double human_age = 0.0;           // s: how long ago each was where the distance has it
  double robot_age = 0.0;
};

// Its terms, m, rounded up. Sum is C + Z_d + Z_r more than their sum.
struct ProtectiveDistance {
  double human = 0.0;     // S_h: what people cover until the robot stands
  double robot = 0.0;     // S_r: what the robot covers until it brakes
  double stopping = 0.0;  // S_s: and from then until it stands
  double sum = 0.0;       // S_p
};

// With the robot at `speed`, m/s, from now on. Never less for a larger speed, to the bit.
[[nodiscard]] ProtectiveDistance protective_distance(const Separation& terms,
                                                     const Approach& approach,
                                                     double speed) noexcept;

// The largest speed of the robot, m/s, with which `distance`, m, is enough; 0 when that is not even
// enough for a robot that stands, infinity when the speed does not matter. Where it is not 0,
// protective_distance() of it, and of anything slower, is not above `distance`.
[[nodiscard]] double largest_speed(const Separation& terms, const Approach& approach,
                                   double distance) noexcept;

}  // namespace clearance
