#include "config/write/single_robot_cell.hpp"

#include <fmt/format.h>

#include <variant>

#include "config/urdf/urdf.hpp"
#include "config/yaml/yaml_emitter.hpp"

namespace clearance {
namespace {

// Returns a name for the cell: that of the robot, or that of the file if the URDF cannot be read.
// The reader of the cell reports that fault.
std::string name_of(const std::filesystem::path& urdf) {
  const auto read = read_urdf(urdf);
  const auto* robot = std::get_if<UrdfRobot>(&read);
  const std::string name = robot == nullptr ? urdf.stem().string() : robot->name;
  return name.empty() ? "robot" : name;
}

std::string path_text(const std::filesystem::path& path) {
  return std::filesystem::absolute(path).lexically_normal().string();
}

}  // namespace

std::string single_robot_cell(const SingleRobotOptions& options) {
  const std::string name = name_of(options.urdf);
  YAML::Emitter out;
  out << YAML::BeginMap << YAML::Key << "name" << YAML::Value << YAML::DoubleQuoted << name;
  out << YAML::Key << "units" << YAML::Value << YAML::Flow << YAML::BeginMap << YAML::Key
      << "length" << YAML::Value << "m" << YAML::Key << "angle" << YAML::Value << "rad"
      << YAML::EndMap;
  out << YAML::Key << "defaults" << YAML::Value << YAML::Flow << YAML::BeginMap << YAML::Key
      << "age_limit_ms" << YAML::Value << options.age_limit_ms;
  out << YAML::EndMap;
  out << YAML::Key << "robots" << YAML::Value << YAML::BeginSeq << YAML::BeginMap;
  out << YAML::Key << "name" << YAML::Value << YAML::DoubleQuoted << name;
  out << YAML::Key << "urdf" << YAML::Value << YAML::DoubleQuoted << path_text(options.urdf);
  if (!options.srdf.empty()) {
    out << YAML::Key << "srdf" << YAML::Value << YAML::DoubleQuoted << path_text(options.srdf);
  }
  if (!options.joint_states.empty()) {
    out << YAML::Key << "joint_states" << YAML::Value << YAML::DoubleQuoted << options.joint_states;
  }
  if (!options.stamps.empty()) out << YAML::Key << "stamps" << YAML::Value << options.stamps;
  if (!options.packages.empty()) {
    out << YAML::Key << "packages" << YAML::Value << YAML::BeginMap;
    for (const auto& [package, directory] : options.packages) {
      out << YAML::Key << YAML::DoubleQuoted << package << YAML::Value << YAML::DoubleQuoted
          << path_text(directory);
    }
    out << YAML::EndMap;
  }
  out << YAML::EndMap << YAML::EndSeq;
  out << YAML::Key << "pairs" << YAML::Value << YAML::BeginSeq << YAML::Flow << YAML::BeginMap
      << YAML::Key << "between" << YAML::Value << YAML::BeginSeq << YAML::DoubleQuoted << name
      << YAML::DoubleQuoted << name << YAML::EndSeq << YAML::EndMap << YAML::EndSeq;
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

CellResult read_single_robot(const SingleRobotOptions& options, const CellOptions& cell_options) {
  CellOptions of_urdf = cell_options;
  of_urdf.is_of_urdf = true;
  const std::filesystem::path file =
      options.directory.empty() ? options.urdf : options.directory / options.urdf.filename();
  return parse_cell(single_robot_cell(options), file, of_urdf);
}

}  // namespace clearance
