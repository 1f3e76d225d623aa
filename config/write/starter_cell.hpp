// Writes a cell to start from: robots side by side, bodies that most cells have, and a comment with
// the unit beside each value that a person has to check.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "config/scene/robot.hpp"
#include "core/vec.hpp"

namespace clearance {

// A robot as its description was read, without a prefix. Coordinates are in the frame of its root
// link, with all joints at zero, or at the limit next to it.
struct StarterRobot {
  std::string name;    // in the cell
  std::string prefix;  // in the cell; may be empty
  std::filesystem::path urdf, srdf;
  std::string srdf_comment;
  std::vector<std::pair<std::string, std::filesystem::path>> packages;
  std::vector<JointVariable> variables;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  // m: a box around all links
  double reach = 0.0;                            // m: along x, in any posture
  // Links that turn about the vertical near their base: their height never changes.
  std::vector<std::string> turning;
  double lowest = 0.0;      // m: of all other links that move
  std::string lowest_link;  // which one
  // Links that touch there, and that the SRDF does not disable.
  std::vector<std::pair<std::string, std::string>> touching;
};

struct StarterOptions {
  std::string name;
  std::filesystem::path directory;  // of the cell: paths are relative to it
  std::vector<StarterRobot> robots;
  bool table = false, machine = false, person = false, camera = false;
};

// With the joints where StarterRobot has them, nothing in the cell touches but what it allows.
[[nodiscard]] std::string starter_cell(const StarterOptions& options);

}  // namespace clearance
