// Robots that are told by their joints: what the kinematics costs, and the tick with and without
// it.
#pragma once

#include <filesystem>
#include <vector>

namespace clearance::bench {

// robot/kinematics/NAME, robot/tick/poses/NAME, robot/tick/joints/NAME and
// robot/tick/gradients/NAME for each of these cells that has a robot.
void register_robots(const std::vector<std::filesystem::path>& cells);

}  // namespace clearance::bench
