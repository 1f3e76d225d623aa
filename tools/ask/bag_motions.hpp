// The motions of a ROS 2 bag: each trajectory_msgs/JointTrajectory, with the joint states before
// it as the intake of the cell reads them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/interface/question.hpp"

namespace clearance {

struct BagMotion {
  std::string id;  // "/arm/joint_trajectory at 12.345 s": the time since the first message
  // The motion, and all other joints of the cell where they were then; or why there is none.
  std::variant<JointTrajectory, std::string> motion = {};
  std::vector<StatedJoint> joints = {};
  std::int64_t log_ns = 0;
};

// Calls `use` for each motion of a bag, in order. Returns an empty text, or what is wrong with the
// bag; the motions before that were used.
[[nodiscard]] std::string for_each_motion(const Cell& cell, const std::filesystem::path& bag,
                                          const std::function<void(const BagMotion&)>& use);

}  // namespace clearance
