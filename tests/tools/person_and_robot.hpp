// A cell with a person and a robot, 1.7 m from surface to surface, whose zone has `separation`.
#pragma once

namespace clearance::test {

inline constexpr const char* kPersonAndRobot = R"(name: hall
units: {length: m, angle: deg}
rate_hz: 200
defaults: {age_limit_ms: 300}
objects:
  - {name: person, sphere: {radius: 0.2}}
  - {name: robot, sphere: {radius: 0.1}}
pairs: [{between: [person, robot]}]
zones:
  - name: people
    between: [person, robot]
    enter_below: 0.3
    leave_above: 0.4
    separation: {human: person, reaction_time_ms: 100, stopping_time_ms: 250,
                 stopping_distance: 0.125, stopping_speed: 1, intrusion_distance: 0.1}
simulation:
  movers: [{object: person, centre: {xyz: [2, 0, 0]}}, {object: robot}]
)";

}  // namespace clearance::test
