// Speed and separation monitoring of a zone: the terms of the protective separation distance of
// ISO/TS 15066, 5.5.4, in the words of ISO 13855. monitor/separation/README.md has the formula.
#pragma once

#include <cstdint>
#include <vector>

#include "core/convex_body.hpp"

namespace clearance {

// All of SI units. Times count from the tick on: the ages of poses are measured and added.
struct Separation {
  // m/s, towards the robot, of a person of whose speed nothing is known: ISO 13855.
  double human_speed = 1.6;
  // The person's own speed is used while it is known, as of one who may accelerate so, m/s2.
  bool human_speed_is_measured = false;
  double human_acceleration = 0.0;
  // Where the robot's speed is not known, m/s; infinity: as Object::max_speed says.
  double robot_speed = kInfinity;
  double robot_acceleration = 0.0;    // m/s2, until the brake begins to act
  std::int64_t reaction_time_ns = 0;  // T_r: from the tick until then
  std::int64_t stopping_time_ns = 0;  // T_s: from then until the robot stands
  double stopping_distance = 0.0;     // B, m: what it covers meanwhile
  // The robot's speed at which T_s and B were measured, m/s. Stated, they scale with the robot's
  // present speed as under a constant deceleration; 0: they hold as they are at any speed.
  double stopping_speed = 0.0;
  double intrusion_distance = 0.0;  // C, m: how far a part of the body can be in unseen
  double human_uncertainty = 0.0;   // Z_d, m
  double robot_uncertainty = 0.0;   // Z_r, m
  // Whether the first object of each pair of the zone is the human one, in the zone's order.
  std::vector<std::uint8_t> human_is_first;
};

}  // namespace clearance
