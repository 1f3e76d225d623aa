#include "config/robot_files.hpp"

#include <cmath>
#include <numbers>
#include <system_error>

namespace clearance {
namespace {

const std::string kPackage = "package://", kFile = "file://";

// 24 sides stand out by 1 / cos(pi / 24) - 1 = 0.86 % of the radius; more sides are slower to query
// and little nearer to the cylinder.
constexpr int kCylinderSides = 24;

// A package that is named wins. Otherwise the search goes upwards, as packages usually contain the
// description that refers to them.
std::optional<std::filesystem::path> directory_of(const std::string& package,
                                                  const RobotFiles& files) {
  for (const auto& [name, directory] : files.packages) {
    if (name == package) return directory;
  }
  std::filesystem::path at =
      std::filesystem::absolute(files.named_in).lexically_normal().parent_path();
  for (; at.has_relative_path(); at = at.parent_path()) {
    if (at.filename() == package) return at;
    if (std::error_code fault; std::filesystem::is_directory(at / package, fault))
      return at / package;
  }
  return std::nullopt;
}

}  // namespace

std::string package_of(const std::string& name) {
  if (!name.starts_with(kPackage)) return "";
  return name.substr(kPackage.size(), name.find('/', kPackage.size()) - kPackage.size());
}

std::optional<std::filesystem::path> RobotFiles::find(const std::string& name) const {
  std::filesystem::path path;
  if (name.starts_with(kPackage)) {
    const std::size_t slash = name.find('/', kPackage.size());
    const auto directory = directory_of(package_of(name), *this);
    if (!directory || slash == std::string::npos) return std::nullopt;
    path = *directory / name.substr(slash + 1);
  } else if (name.starts_with(kFile)) {
    path = name.substr(kFile.size());
  } else {
    path = named_in.parent_path() / name;  // an absolute path stays as it is
  }
  return std::filesystem::absolute(path).lexically_normal();
}

// The matrix product has z on the left.
Pose pose_of(const UrdfOrigin& origin) {
  return {origin.xyz, Eigen::AngleAxisd(origin.rpy.z(), Vec3::UnitZ()) *
                          Eigen::AngleAxisd(origin.rpy.y(), Vec3::UnitY()) *
                          Eigen::AngleAxisd(origin.rpy.x(), Vec3::UnitX())};
}

// The vertices are farther out by 1 / cos(pi / sides), and a little more, so that rounding cannot
// cut into the cylinder.
std::vector<Vec2> prism_around(const UrdfCylinder& cylinder) {
  const double vertex_radius =
      cylinder.radius / std::cos(std::numbers::pi / kCylinderSides) * (1.0 + 1e-12);
  std::vector<Vec2> base;
  for (int i = 0; i < kCylinderSides; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / kCylinderSides;
    base.emplace_back(vertex_radius * std::cos(angle), vertex_radius * std::sin(angle));
  }
  return base;
}

}  // namespace clearance
