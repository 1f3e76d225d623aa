#include "config/urdf/robot_files.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <sstream>
#include <system_error>

#include "config/scene/revision.hpp"

namespace clearance {
namespace {

const std::string kPackage = "package://", kFile = "file://";

// An installation or a workspace of ROS 2 has its packages in PREFIX/share.
std::vector<std::filesystem::path> installed_shares() {
  const char* const prefixes = std::getenv("AMENT_PREFIX_PATH");
  std::istringstream list(prefixes == nullptr ? "" : prefixes);
  std::vector<std::filesystem::path> shares;
  for (std::string prefix; std::getline(list, prefix, ':');)
    if (!prefix.empty()) shares.push_back(std::filesystem::path(prefix) / "share");
  return shares;
}

std::optional<std::filesystem::path> installed_package(const std::string& package) {
  for (const std::filesystem::path& share : installed_shares()) {
    if (std::error_code fault; std::filesystem::is_directory(share / package, fault))
      return share / package;
  }
  return std::nullopt;
}

// Looks under the root of another machine for a package that was installed there, at any path.
std::optional<std::filesystem::path> kept_package(const std::string& package,
                                                  const std::filesystem::path& root) {
  std::error_code fault;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root, fault)) {
    if (entry.is_directory(fault) && entry.path().filename() == package) return entry.path();
  }
  return std::nullopt;
}

// The folder from which the search goes upwards.
std::filesystem::path first_folder(const RobotFiles& files) {
  return std::filesystem::absolute(files.named_in).lexically_normal().parent_path();
}

// Names the folders that directory_of() looks in.
std::string searched(const RobotFiles& files) {
  if (!files.root.empty()) return fmt::format("{} and its folders", files.root.string());
  std::string shares;
  for (const std::filesystem::path& share : installed_shares())
    shares += (shares.empty() ? "" : ", ") + share.string();
  return fmt::format("{}, the folders above it, and {}", first_folder(files).string(),
                     shares.empty() ? "AMENT_PREFIX_PATH, which names none"
                                    : fmt::format("AMENT_PREFIX_PATH's {}", shares));
}

// A package that the cell names wins. Otherwise the search goes upwards, as packages usually
// contain the description that refers to them. Installed packages of ROS 2 come last.
std::optional<std::filesystem::path> directory_of(const std::string& package,
                                                  const RobotFiles& files) {
  for (const auto& [name, directory] : files.packages) {
    if (name == package) return directory;
  }
  std::filesystem::path at = first_folder(files);
  for (; at.has_relative_path() && !leads_out_of(files.root, at); at = at.parent_path()) {
    if (at.filename() == package) return at;
    if (std::error_code fault; std::filesystem::is_directory(at / package, fault))
      return at / package;
  }
  return files.root.empty() ? installed_package(package) : kept_package(package, files.root);
}

// A path through a symbolic link stays allowed, because workspaces of ROS 2 are built of such
// links.
bool leaves_package(const std::string& name) {
  const std::string package = package_of(name);
  if (package.empty() || package == "." || package == "..") return true;
  const std::size_t slash = name.find('/', kPackage.size());
  if (slash == std::string::npos) return false;
  const auto within = std::filesystem::path(name.substr(slash + 1)).lexically_normal();
  return within.is_absolute() || (!within.empty() && *within.begin() == "..");
}

}  // namespace

std::string RobotFiles::why_not_found(const std::string& name, PackagesFrom from) const {
  if (name.starts_with(kPackage) && package_of(name).empty()) {
    return fmt::format("'{}' names no package; expected {}NAME/PATH, or file://PATH", name,
                       kPackage);
  }
  if (name.starts_with(kPackage) && leaves_package(name)) {
    return fmt::format("'{}' leads out of its package; expected {}NAME/PATH with a path within it",
                       name, kPackage);
  }
  if (path_of(name)) return fmt::format("it {}; expected a path within them", kLeadsOut);
  const std::string package = package_of(name);
  return fmt::format(
      "no directory for the package '{0}' in {1}; expected {2}{3}", package, searched(*this),
      from == PackagesFrom::kCell ? fmt::format("packages: {{{}: DIRECTORY}}", package)
                                  : fmt::format("--package {}=DIRECTORY", package),
      root.empty() ? fmt::format(", or PREFIX/share/{} with PREFIX in "
                                 "AMENT_PREFIX_PATH",
                                 package)
                   : "");
}

std::string package_of(const std::string& name) {
  if (!name.starts_with(kPackage)) return "";
  return name.substr(kPackage.size(), name.find('/', kPackage.size()) - kPackage.size());
}

std::optional<std::filesystem::path> RobotFiles::find(const std::string& name) const {
  const auto path = path_of(name);
  if (!path || leads_out_of(root, *path)) return std::nullopt;
  return path;
}

std::optional<std::filesystem::path> MeshFinder::find(const UrdfMesh& mesh, UrdfFaults& faults) {
  const auto path = files_.find(mesh.file);
  if (std::error_code fault; path && std::filesystem::is_regular_file(*path, fault)) return path;
  const std::string package = package_of(mesh.file);
  if (!path && !package.empty() && !missing_.insert(package).second) return std::nullopt;
  faults.push_back(fault_at(files_.named_in.string(), mesh.place,
                            fmt::format("found the mesh '{}', and {}", mesh.file,
                                        path ? fmt::format("no file '{}'", path->string())
                                             : files_.why_not_found(mesh.file, from_))));
  return std::nullopt;
}

std::optional<std::filesystem::path> RobotFiles::path_of(const std::string& name) const {
  std::filesystem::path path;
  if (name.starts_with(kPackage)) {
    if (leaves_package(name)) return std::nullopt;
    const std::size_t slash = name.find('/', kPackage.size());
    const auto directory = directory_of(package_of(name), *this);
    if (!directory || slash == std::string::npos) return std::nullopt;
    path = *directory / name.substr(slash + 1);
  } else if (name.starts_with(kFile)) {
    path = path_in(root, "", name.substr(kFile.size()));
  } else {
    path = path_in(root, named_in.parent_path(), name);
  }
  return std::filesystem::absolute(path).lexically_normal();
}

// In the matrix product, z stands on the left.
Pose pose_of(const UrdfOrigin& origin) {
  if (origin.quaternion) return {origin.xyz, *origin.quaternion};
  return {origin.xyz, Eigen::AngleAxisd(origin.rpy.z(), Vec3::UnitZ()) *
                          Eigen::AngleAxisd(origin.rpy.y(), Vec3::UnitY()) *
                          Eigen::AngleAxisd(origin.rpy.x(), Vec3::UnitX())};
}

}  // namespace clearance
