// Makes the cell of one robot and nothing else, from a URDF without a cell file. The robot is
// driven by joint states.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "config/cell/cell_file.hpp"

namespace clearance {

struct SingleRobotOptions {
  std::filesystem::path urdf;
  std::filesystem::path srdf = {};  // empty: neighbours may touch
  // The same as `packages:` of a robot in a cell.
  std::vector<std::pair<std::string, std::filesystem::path>> packages = {};
  double age_limit_ms = 20.0;     // of its joints
  std::string joint_states = {};  // the topic of ROS 2 that has its joints; empty: any by that name
  std::string stamps = {};        // the key of its robot; empty: not stated
  // The folder of the cell that will be written: parts of meshes are kept there. Empty: beside the
  // URDF.
  std::filesystem::path directory = {};
};

// Returns the text of the cell. The robot stands in the world, under its URDF's name, and every
// pair of its links is watched and published.
[[nodiscard]] std::string single_robot_cell(const SingleRobotOptions& options);

// Reads that text; the errors name the URDF, and its lines where they are of one.
[[nodiscard]] CellResult read_single_robot(const SingleRobotOptions& options,
                                           const CellOptions& cell_options = {});

}  // namespace clearance
