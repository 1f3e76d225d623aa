// The smallest cell, and a tick with one pose.
#pragma once

#include <span>

#include "monitor/monitor.hpp"
#include "tests/monitor/small_cells.hpp"

namespace clearance::test {

// Two balls of radius 0.1. The second one is fixed, 1 m along x.
inline Scene two_balls() {
  Scene scene = cell_of({moving("a", {ball(0.1)}), fixed("b", {ball(0.1)}, at(1, 0, 0))});
  scene.pairs[0].publish = true;
  return scene;
}

inline const Report& tick_with(Monitor& monitor, std::uint32_t object, const Pose& pose,
                               std::int64_t now_ns) {
  const PoseSample moved = sample(object, pose, now_ns);
  return monitor.tick(std::span(&moved, 1), now_ns);
}

}  // namespace clearance::test
