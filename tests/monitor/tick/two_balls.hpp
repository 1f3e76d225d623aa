// The smallest cell, its samples, and a tick with one pose.
#pragma once

#include <cstdint>
#include <span>

#include "monitor/tick/monitor.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance::test {

// Two balls of radius 0.1. The second one is fixed, 1 m along x.
inline Scene two_balls() {
  Scene scene = cell_of({moving("a", {ball(0.1)}), fixed("b", {ball(0.1)}, at(1, 0, 0))});
  scene.pairs[0].publish = true;
  return scene;
}

// The same, where the first ball may move at most so fast, m/s.
inline Scene balls_of_speed(double max_speed) {
  Scene scene = two_balls();
  scene.objects[0].may_jump = false;
  scene.objects[0].max_speed = max_speed;
  return scene;
}

// A pose of the first ball, with its velocity in m/s.
inline PoseSample with_twist(const Pose& pose, const Vec3& linear, std::int64_t stamp_ns) {
  PoseSample moved = sample(0, pose, stamp_ns);
  moved.has_twist = true;
  moved.twist.linear = linear;
  return moved;
}

// The number of poses of the first ball that were refused for this cause.
inline std::uint64_t rejected(const Monitor& monitor, Reject cause) {
  return monitor.rejected(0)[static_cast<std::size_t>(cause)];
}

inline const Report& tick_with(Monitor& monitor, std::uint32_t object, const Pose& pose,
                               std::int64_t now_ns) {
  const PoseSample moved = sample(object, pose, now_ns);
  return monitor.tick(std::span(&moved, 1), now_ns);
}

}  // namespace clearance::test
