// A cell in which a hand and a tool may come near a box, for recordings that are replayed.
#pragma once

namespace clearance::test {

inline constexpr const char* kBenchCell = R"(name: bench
units: {length: m, angle: deg}
defaults: {age_limit_ms: 50, max_speed: 2, may_jump: true}
objects:
  - {name: hand, groups: [robot], sphere: {radius: 0.05}}
  - {name: tool, groups: [robot], box: {size: [0.1, 0.1, 0.1]}}
  - {name: box, groups: [still], fixed: true, box: {size: [0.2, 0.2, 0.2]}}
pairs:
  - {between: [robot, still], publish: true}
zones:
  - {name: stop, between: [robot, still], enter_below: 0.1, leave_above: 0.15}
)";

}  // namespace clearance::test
