// The keys of a robot in a cell file, before the files that they name are read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "config/cell/object_reader.hpp"
#include "config/cell/person_reader.hpp"
#include "config/scene/ros_stamps.hpp"
#include "config/yaml/quantities.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// The values of a robot's own keys.
struct RobotKeys {
  const YamlNode* name_node = nullptr;
  const YamlNode* urdf_node = nullptr;
  const YamlNode* srdf_node = nullptr;
  const YamlNode* combined_node = nullptr;  // srdf_with
  const YamlNode* base_node = nullptr;
  const YamlNode* attached_node = nullptr;
  const YamlNode* joints_node = nullptr;
  const YamlNode* stopping_node = nullptr;
  const YamlNode* person_node = nullptr;
  PersonKeys person;
  std::vector<std::string> groups;                   // beside its name
  std::vector<const YamlNode*> visual_as_collision;  // names of links
  std::string name, prefix, joint_states;
  RosStamps stamps = RosStamps::kMessage;
  std::vector<std::pair<std::string, std::filesystem::path>> packages;
  ObjectDefaults limits;
  std::int64_t frozen_limit_ns = 0;  // of all joints
  bool absent = false;
  double mass = kInfinity;  // kg

  // The key that describes its links.
  [[nodiscard]] const YamlNode& description() const {
    return urdf_node != nullptr ? *urdf_node : *person_node;
  }
};

// The folder of the cell, and the root as of path_in().
struct RobotFolders {
  std::filesystem::path cell, root;
};

[[nodiscard]] RobotKeys read_robot_keys(const YamlNode& node, const ObjectDefaults& defaults,
                                        const RobotFolders& folders, const Quantities& quantities);

}  // namespace clearance
