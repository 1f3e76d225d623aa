// Where the files are that a robot's description names, and its shapes and frames in our terms:
// shared by the cells that robots are written to and the cells that name robots.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/urdf/urdf.hpp"
#include "core/pose.hpp"

namespace clearance {

// Files are named as package://NAME/PATH, file://PATH, or by a path relative to the file that names
// them.
struct RobotFiles {
  std::filesystem::path named_in;
  // package:// names and where they are. Others are looked for in the directory of `named_in` and
  // those above it, a directory of that name or one within, and then where AMENT_PREFIX_PATH says.
  std::vector<std::pair<std::string, std::filesystem::path>> packages;
  std::filesystem::path root = {};  // as of path_in()

  // The absolute path, whether there is such a file or not; nothing: its package is nowhere.
  [[nodiscard]] std::optional<std::filesystem::path> find(const std::string& name) const;
};

// NAME of package://NAME/PATH; empty: the name has none.
[[nodiscard]] std::string package_of(const std::string& name);

// Rpy of URDF: rotations about the fixed axes x, then y, then z.
[[nodiscard]] Pose pose_of(const UrdfOrigin& origin);

}  // namespace clearance
