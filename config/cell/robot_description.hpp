// Reads the files that describe a robot, as a cell names them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/scene/revision.hpp"
#include "config/urdf/robot_files.hpp"
#include "config/urdf/robot_model.hpp"
#include "config/urdf/urdf.hpp"
#include "config/yaml/diagnostics.hpp"

namespace clearance {

// The entry `person` of a robot.
struct DescribedPerson {
  const YamlNode* node = nullptr;  // null: the robot is no person
  std::string name;                // of the robot that stands for the person
  double stature = 0.0;            // m
  std::string id;                  // of the body; as Person::id
};

// The names of the files in a cell, and their places.
struct DescriptionKeys {
  const YamlNode* urdf = nullptr;  // null: missing, which has been reported, or a person's
  const YamlNode* srdf = nullptr;  // null: there is none
  RobotFiles files;                // of the cell
  std::string prefix;
  std::vector<const YamlNode*> visual_as_collision;  // names of links
  DescribedPerson person = {};
};

// Finds the file that a key of a robot names. Returns nothing after a diagnostic. The file's bytes
// go into the revision.
[[nodiscard]] std::optional<std::filesystem::path> find_robot_file(const YamlNode& node,
                                                                   const RobotFiles& files,
                                                                   Diagnostics& diagnostics,
                                                                   Revision& revision);

// A URDF, its SRDF if there is one, and the tree that they describe.
struct RobotDescription {
  std::filesystem::path urdf;
  UrdfRobot robot;
  std::optional<Srdf> srdf;
  RobotModel model;
};

// Returns nothing after a diagnostic. The files' bytes go into the revision.
[[nodiscard]] std::optional<RobotDescription> read_description(const DescriptionKeys& keys,
                                                               Diagnostics& diagnostics,
                                                               Revision& revision);

}  // namespace clearance
