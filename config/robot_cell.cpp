#include "config/robot_cell.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <system_error>

#include "core/pose.hpp"

namespace clearance {
namespace {

constexpr int kCylinderSides = 24;

// The shortest decimal that reads back to the same double.
std::string text(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value == 0.0 ? 0.0 : value);
  return {buffer, result.ptr};
}

std::string text(const Vec3& v) {
  std::string list = "[";
  list += text(v.x()) + ", " + text(v.y()) + ", " + text(v.z()) + "]";
  return list;
}

// A double-quoted YAML scalar.
std::string yaml_text(const std::string& value) {
  std::string result = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

bool is_identity(const UrdfOrigin& origin) {
  return origin.xyz == Vec3::Zero() && origin.rpy == Vec3::Zero();
}

Pose pose(const UrdfOrigin& origin) {
  return {origin.xyz, Eigen::AngleAxisd(origin.rpy.z(), Vec3::UnitZ()) *
                          Eigen::AngleAxisd(origin.rpy.y(), Vec3::UnitY()) *
                          Eigen::AngleAxisd(origin.rpy.x(), Vec3::UnitX())};
}

class RobotCellWriter {
 public:
  RobotCellWriter(const RobotCellOptions& options, UrdfRobot robot,
                  std::vector<SrdfDisabled> disabled)
      : options_(options),
        robot_(std::move(robot)),
        disabled_(std::move(disabled)),
        group_(options.group.empty() ? robot_.name : options.group) {}

  std::variant<RobotCell, UrdfFault> write();

 private:
  void find_fixed_links();
  bool watched(const std::string& link) const;
  std::string header() const;
  std::string object(const UrdfLink& link);
  std::string shape(const UrdfCollision& collision);
  std::string prism_around(const UrdfCylinder& cylinder) const;
  std::string exceptions();
  std::string mesh_path(const std::string& file);
  std::optional<std::filesystem::path> package_directory(const std::string& name) const;

  const RobotCellOptions& options_;
  UrdfRobot robot_;
  std::vector<SrdfDisabled> disabled_;
  std::string group_;
  std::map<std::string, Pose> fixed_;  // links that never move, in the world
  std::vector<std::string> notes_;
  std::string fault_;  // the first thing that cannot be written
};

// The root and what fixed joints join to it. The URDF is a tree, so each round fixes what the last
// reached.
void RobotCellWriter::find_fixed_links() {
  if (!options_.fixed_base) return;
  std::set<std::string> children;
  for (const UrdfJoint& joint : robot_.joints) children.insert(joint.child);
  for (const UrdfLink& link : robot_.links) {
    if (!children.contains(link.name)) fixed_[link.name] = Pose{};
  }
  for (bool grown = true; grown;) {
    grown = false;
    for (const UrdfJoint& joint : robot_.joints) {
      if (joint.type != "fixed" || !fixed_.contains(joint.parent) || fixed_.contains(joint.child))
        continue;
      fixed_[joint.child] = compose(fixed_[joint.parent], pose(joint.parent_from_child));
      grown = true;
    }
  }
}

std::optional<std::filesystem::path> RobotCellWriter::package_directory(
    const std::string& name) const {
  for (const auto& [package, directory] : options_.packages) {
    if (package == name) return directory;
  }
  std::filesystem::path at =
      std::filesystem::absolute(options_.urdf).lexically_normal().parent_path();
  for (; at.has_relative_path(); at = at.parent_path()) {
    if (at.filename() == name) return at;
    if (std::error_code fault; std::filesystem::is_directory(at / name, fault)) return at / name;
  }
  return std::nullopt;
}

// Where the mesh is, relative to the cell.
std::string RobotCellWriter::mesh_path(const std::string& file) {
  static const std::string kPackage = "package://", kFile = "file://";
  std::filesystem::path path;
  if (file.starts_with(kPackage)) {
    const std::size_t slash = file.find('/', kPackage.size());
    const std::string name = file.substr(kPackage.size(), slash - kPackage.size());
    const auto directory = package_directory(name);
    if (!directory || slash == std::string::npos) {
      if (fault_.empty()) {
        fault_ = options_.urdf.string() + ":1: found the mesh '" + file +
                 "', and no directory for the package '" + name + "'; expected --package " + name +
                 "=DIRECTORY";
      }
      return file;
    }
    path = *directory / file.substr(slash + 1);
  } else if (file.starts_with(kFile)) {
    path = file.substr(kFile.size());
  } else {
    path = options_.urdf.parent_path() / file;  // an absolute path stays as it is
  }
  path = std::filesystem::absolute(path).lexically_normal();
  if (std::error_code fault; !std::filesystem::is_regular_file(path, fault) && fault_.empty()) {
    fault_ = options_.urdf.string() + ":1: found the mesh '" + file + "', and no file '" +
             path.string() + "'";
  }
  const auto directory = std::filesystem::absolute(options_.directory).lexically_normal();
  return path.lexically_relative(directory).string();
}

// Its sides touch the cylinder: the corners are farther out by 1 / cos(pi / sides).
std::string RobotCellWriter::prism_around(const UrdfCylinder& cylinder) const {
  // A little more than the exact factor, so that rounding cannot cut into the cylinder.
  const double corner =
      cylinder.radius / std::cos(std::numbers::pi / kCylinderSides) * (1.0 + 1e-12);
  std::string base;
  for (int i = 0; i < kCylinderSides; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / kCylinderSides;
    base += std::string(i == 0 ? "" : ", ") + "[" + text(corner * std::cos(angle)) + ", " +
            text(corner * std::sin(angle)) + "]";
  }
  return "prism: {base: [" + base + "], z: [" + text(-0.5 * cylinder.length) + ", " +
         text(0.5 * cylinder.length) + "]}";
}

std::string RobotCellWriter::shape(const UrdfCollision& collision) {
  if (const auto* mesh = std::get_if<UrdfMesh>(&collision.shape)) {
    const std::string scale = mesh->scale == Vec3::Ones() ? "" : ", scale: " + text(mesh->scale);
    return "mesh: {file: " + yaml_text(mesh_path(mesh->file)) + scale + "}";
  }
  if (const auto* box = std::get_if<UrdfBox>(&collision.shape))
    return "box: {size: " + text(box->size) + "}";
  if (const auto* sphere = std::get_if<UrdfSphere>(&collision.shape)) {
    return "sphere: {radius: " + text(sphere->radius) + "}";
  }
  return prism_around(std::get<UrdfCylinder>(collision.shape));
}

std::string RobotCellWriter::object(const UrdfLink& link) {
  std::string yaml =
      "  - name: " + yaml_text(link.name) + "\n    groups: [" + yaml_text(group_) + "]\n";
  if (const auto found = fixed_.find(link.name); found != fixed_.end()) {
    const Eigen::Quaterniond& q = found->second.orientation;
    yaml += "    fixed: true\n    pose: {xyz: " + text(found->second.position) + ", quaternion: [" +
            text(q.x()) + ", " + text(q.y()) + ", " + text(q.z()) + ", " + text(q.w()) + "]}\n";
  }
  yaml += "    parts:\n";
  for (const UrdfCollision& collision : link.collisions) {
    yaml += "      - " + shape(collision) + "\n";
    if (is_identity(collision.link_from_shape)) continue;
    yaml += "        pose: {xyz: " + text(collision.link_from_shape.xyz) +
            ", rpy: " + text(collision.link_from_shape.rpy) + "}\n";
  }
  return yaml;
}

bool RobotCellWriter::watched(const std::string& link) const {
  return std::any_of(robot_.links.begin(), robot_.links.end(), [&](const UrdfLink& candidate) {
    return candidate.name == link && !candidate.collisions.empty();
  });
}

// The SRDF speaks of links without shapes too, and sometimes of a pair twice: neither is an
// exception of ours.
std::string RobotCellWriter::exceptions() {
  std::string yaml;
  std::set<std::pair<std::string, std::string>> seen;
  std::size_t left_out = 0;
  for (const SrdfDisabled& entry : disabled_) {
    const bool both_fixed = fixed_.contains(entry.link_a) && fixed_.contains(entry.link_b);
    const bool useful = watched(entry.link_a) && watched(entry.link_b) && !both_fixed &&
                        entry.link_a != entry.link_b &&
                        seen.insert(std::minmax(entry.link_a, entry.link_b)).second;
    if (!useful) {
      ++left_out;
      continue;
    }
    yaml += "  - {between: [" + yaml_text(entry.link_a) + ", " + yaml_text(entry.link_b) +
            "], reason: " + yaml_text(entry.reason) + "}\n";
  }
  if (left_out > 0) {
    notes_.push_back(
        std::to_string(left_out) +
        " disabled pairs left out: a link without collision shapes, named twice, or both fixed");
  }
  return yaml.empty() ? "" : "\nallowed_collisions: # from the SRDF\n" + yaml;
}

std::string RobotCellWriter::header() const {
  std::string yaml = "# Written by clearance-scene from " + options_.urdf.filename().string();
  if (!options_.srdf.empty()) yaml += " and " + options_.srdf.filename().string();
  yaml += ".\nname: " + yaml_text(robot_.name) + "\nunits: {length: m, angle: rad}\n\ndefaults:\n";
  if (options_.max_speed > 0.0) yaml += "  max_speed: " + text(options_.max_speed) + "\n";
  return yaml + "  age_limit_ms: " + text(options_.age_limit_ms) + "\n\nobjects:\n";
}

std::variant<RobotCell, UrdfFault> RobotCellWriter::write() {
  find_fixed_links();
  std::string yaml = header();
  std::string without;
  for (const UrdfLink& link : robot_.links) {
    if (link.collisions.empty()) {
      without += (without.empty() ? "" : ", ") + link.name;
    } else {
      yaml += object(link);
    }
  }
  if (!without.empty()) notes_.push_back("links without collision shapes left out: " + without);
  yaml += "\npairs:\n  - {between: [" + yaml_text(group_) + ", " + yaml_text(group_) + "]}\n" +
          exceptions();
  if (!fault_.empty()) return UrdfFault{fault_};
  return RobotCell{std::move(yaml), std::move(notes_)};
}

}  // namespace

std::variant<RobotCell, UrdfFault> robot_cell(const RobotCellOptions& options) {
  auto robot = read_urdf(options.urdf);
  if (const auto* fault = std::get_if<UrdfFault>(&robot)) return *fault;
  std::vector<SrdfDisabled> disabled;
  if (!options.srdf.empty()) {
    auto srdf = read_srdf(options.srdf);
    if (const auto* fault = std::get_if<UrdfFault>(&srdf)) return *fault;
    disabled = std::get<std::vector<SrdfDisabled>>(std::move(srdf));
  }
  return RobotCellWriter(options, std::get<UrdfRobot>(std::move(robot)), std::move(disabled))
      .write();
}

}  // namespace clearance
