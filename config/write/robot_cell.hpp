// Writes the cell file of a robot from its URDF and SRDF.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "config/urdf/urdf.hpp"

namespace clearance {

// The settings that URDF and SRDF do not have.
struct RobotCellOptions {
  std::filesystem::path urdf;
  std::filesystem::path srdf;       // empty: neighbours are left out
  std::filesystem::path directory;  // of the cell: mesh paths are written relative to it
  // The same as in RobotFiles: other packages are looked for from the URDF upwards.
  std::vector<std::pair<std::string, std::filesystem::path>> packages;
  double max_speed = 0.0;  // m/s; 0: not stated
  double age_limit_ms = 20.0;
};

// The text of the cell, and notes for the person who asked for it: omissions and their reasons.
struct RobotCell {
  std::string yaml;
  std::vector<std::string> notes;
};

// Each link that has collision shapes becomes an object of the link's name in the link's frame.
// Every pair of them is watched, except those that the SRDF disables. Without an SRDF, the
// exceptions are each link and its nearest ancestor that has shapes. The cell lists exceptions with
// their reasons. An SRDF with another robot's name, or with links that the URDF does not have, is
// refused.
[[nodiscard]] std::variant<RobotCell, UrdfFaults> robot_cell(const RobotCellOptions& options);

}  // namespace clearance
