// Speed and separation monitoring of a zone. These are the terms of the protective separation
// distance of ISO/TS 15066, 5.5.4, named as in ISO 13855. monitor/zones/README.md has the
// formula.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/convex_body.hpp"

namespace clearance {

// All in SI units. Times count from the tick; the measured ages of poses are added.
struct Separation {
  // m/s, towards the robot: the speed of a person whose speed is unknown. Nothing: that of the part
  // of the body, Object::approach_speed.
  std::optional<double> human_speed = {};
  // If set, the person's measured speed is used while it is known, with this acceleration, m/s2.
  bool human_speed_is_measured = false;
  double human_acceleration = 0.0;
  // The robot's speed where it is not known, m/s; infinity: as Object::max_speed.
  double robot_speed = kInfinity;
  double robot_acceleration = 0.0;  // m/s2, until the brake begins to act
  // T_r: from the tick until then. Measured: from when the report is handed to DDS; until then,
  // TickTime::report_delay_ns counts.
  std::int64_t reaction_time_ns = 0;
  bool reaction_is_measured = false;
  std::int64_t stopping_time_ns = 0;  // T_s: from then until the robot stands
  double stopping_distance = 0.0;     // B, m: its path meanwhile
  // The robot's speed at which T_s and B were measured, m/s. They then scale with its present
  // speed, as under a constant deceleration. 0: they hold at any speed.
  double stopping_speed = 0.0;
  double intrusion_distance = 0.0;  // C, m: the depth to which a part of the body can intrude
                                    // before it is detected
  double human_uncertainty = 0.0;   // Z_d, m
  double robot_uncertainty = 0.0;   // Z_r, m
  bool human_is_a = false;          // people are Zone::group_a, else group_b
  // For each pair of the zone, in its order: whether the first object is the human one.
  std::vector<std::uint8_t> human_is_first;
};

}  // namespace clearance
