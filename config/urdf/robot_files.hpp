// Finds the files that a robot's description names. Cells that robots are written to and cells that
// name robots share it.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "config/urdf/urdf.hpp"
#include "core/pose.hpp"

namespace clearance {

// The place that states the folder of a package: a key of the cell, or an option.
enum class PackagesFrom { kCell, kCommandLine };

// A file is named as package://NAME/PATH, as file://PATH, or by a path relative to the file that
// names it.
struct RobotFiles {
  std::filesystem::path named_in;
  // Packages and their folders. Others are looked for in the directory of `named_in` and those
  // above it, as a directory of that name or one within. AMENT_PREFIX_PATH comes last.
  std::vector<std::pair<std::string, std::filesystem::path>> packages;
  std::filesystem::path root = {};  // as of path_in()

  // Returns the absolute path, whether or not there is such a file. Returns nothing if its package
  // was not found, or if its path leads out of the package or of the root, as package://NAME/../x
  // and /../x do.
  [[nodiscard]] std::optional<std::filesystem::path> find(const std::string& name) const;

  // Says why find() returned nothing for this name, as the end of a sentence: "no directory for the
  // package 'x' in FOLDERS; expected ...".
  [[nodiscard]] std::string why_not_found(const std::string& name, PackagesFrom from) const;

 private:
  // Returns the path that the name means, wherever it leads.
  [[nodiscard]] std::optional<std::filesystem::path> path_of(const std::string& name) const;
};

// Finds the meshes of one robot.
class MeshFinder {
 public:
  // `files.named_in` is the URDF.
  MeshFinder(RobotFiles files, PackagesFrom from) : files_(std::move(files)), from_(from) {}

  // Returns the path of the file, or adds a fault. A package that is missing is told once, with the
  // first mesh in it.
  std::optional<std::filesystem::path> find(const UrdfMesh& mesh, UrdfFaults& faults);

 private:
  RobotFiles files_;
  PackagesFrom from_;
  std::set<std::string> missing_;  // packages
};

// Returns NAME of package://NAME/PATH; empty: the name has none.
[[nodiscard]] std::string package_of(const std::string& name);

// Converts a quaternion, or rpy of URDF: rotations about the fixed axes x, then y, then z.
[[nodiscard]] Pose pose_of(const UrdfOrigin& origin);

}  // namespace clearance
