// Makes the tree of joints of a robot from its URDF.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "config/scene/robot.hpp"
#include "config/urdf/urdf.hpp"

namespace clearance {

// The links and joints of one robot, with its joints' variables counted from 0.
struct RobotModel {
  Robot robot;  // of the URDF's name; without a base and without objects
  std::vector<JointVariable> variables;
  // Variables whose velocity limit is negative, which counts as none, and the fault that this is
  // unless the cell states another one.
  std::vector<std::pair<std::string, UrdfFault>> without_speed = {};
};

// Makes the tree; every name gets the prefix. It refuses, with the place in `urdf`: more than one
// root; joints of unknown types, or without the elements of their type. It also refuses axes of
// length zero, limits in the wrong order, and mimic joints that follow nothing or themselves.
[[nodiscard]] std::variant<RobotModel, UrdfFaults> robot_model(const UrdfRobot& description,
                                                               const std::filesystem::path& urdf,
                                                               const std::string& prefix);

// Puts a floating joint below the root, for a robot whose base follows a frame of tf. Its first
// link is then the world, "PREFIXNAME_world"; its first joint and variables are those of
// "PREFIXNAME_base".
void float_root(RobotModel& model, const std::string& prefix, const std::string& name);

}  // namespace clearance
