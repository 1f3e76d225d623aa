#include "config/cell/robot_keys.hpp"

#include <fmt/format.h>

#include "config/cell/ros_reader.hpp"
#include "config/scene/source_name.hpp"
#include "config/text/file_bytes.hpp"
#include "config/yaml/map_reader.hpp"

namespace clearance {
namespace {

class RobotKeysReader {
 public:
  RobotKeysReader(const YamlNode& node, const ObjectDefaults& defaults, const RobotFolders& folders,
                  const Quantities& quantities)
      : node_(node),
        defaults_(defaults),
        folders_(folders),
        quantities_(quantities),
        diagnostics_(quantities.diagnostics()) {}

  RobotKeys read();

 private:
  void read_packages(const YamlNode& node);
  void read_visual_links(const YamlNode& node);
  void read_joint_topic(MapReader& map);

  const YamlNode& node_;
  const ObjectDefaults& defaults_;
  const RobotFolders& folders_;
  const Quantities& quantities_;
  Diagnostics& diagnostics_;
  RobotKeys keys_;
};

void RobotKeysReader::read_packages(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::kMap) {
    diagnostics_.add(node, fmt::format("found {}; expected packages and their directories: {{NAME: "
                                       "DIRECTORY}}",
                                       describe(node)));
  }
  for (const YamlEntry& entry : node.entries) {
    const auto name = read_name(entry.key, "a package's name", diagnostics_);
    const auto path = read_text(entry.value, "the directory of a package", diagnostics_);
    if (name && path)
      keys_.packages.emplace_back(*name, path_in(folders_.root, folders_.cell, *path));
  }
}

void RobotKeysReader::read_visual_links(const YamlNode& node) {
  for (const YamlNode& item : read_list(node, "links whose visual shapes count", diagnostics_)) {
    if (read_name(item, "a link's name, without the prefix", diagnostics_))
      keys_.visual_as_collision.push_back(&item);
  }
}

// Reads the robot's joint-state topic on ROS 2, and whether its stamps or its times of sending
// count.
void RobotKeysReader::read_joint_topic(MapReader& map) {
  if (const YamlNode* node = map.optional("joint_states"))
    keys_.joint_states = read_ros_topic(*node, "/left/joint_states", diagnostics_);
  if (const YamlNode* node = map.optional("stamps"))
    keys_.stamps = read_stamps(*node, diagnostics_);
}

RobotKeys RobotKeysReader::read() {
  keys_.limits = defaults_;
  MapReader map(node_, "a robot", diagnostics_);
  keys_.name_node = map.required("name");
  keys_.person_node = map.optional("person");
  keys_.urdf_node = keys_.person_node != nullptr ? map.optional("urdf") : map.required("urdf");
  keys_.srdf_node = map.optional("srdf");
  keys_.combined_node = map.optional("srdf_with");
  keys_.base_node = map.optional("base");
  keys_.attached_node = map.optional("attached");
  if (keys_.base_node != nullptr && keys_.attached_node != nullptr) {
    diagnostics_.add(*keys_.attached_node,
                     "found 'attached' of a robot with a 'base'; expected one of the two");
  }
  if (const YamlNode* absent = map.optional("absent"))
    keys_.absent = read_flag(*absent, diagnostics_).value_or(false);
  keys_.mass = read_mass(map, diagnostics_);
  keys_.joints_node = map.optional("joints");
  keys_.stopping_node = map.optional("stopping");
  read_joint_topic(map);
  if (keys_.name_node != nullptr) {
    keys_.name = read_name(*keys_.name_node, "a robot's name", diagnostics_).value_or("");
  }
  if (const YamlNode* prefix = map.optional("prefix")) {
    keys_.prefix = read_text(*prefix, "what the names of links and joints begin with", diagnostics_)
                       .value_or("");
  }
  if (const YamlNode* packages = map.optional("packages")) read_packages(*packages);
  if (const YamlNode* links = map.optional("visual_as_collision")) read_visual_links(*links);
  if (const YamlNode* margin = map.optional("margin")) {
    keys_.limits.margin =
        quantities_.length(*margin, "the margin", kNotNegative).value_or(defaults_.margin);
  }
  if (const YamlNode* age = map.optional("age_limit_ms")) {
    keys_.limits.age_limit_ns =
        quantities_.milliseconds(*age, "the age limit", kPositive).value_or(defaults_.age_limit_ns);
  }
  if (const YamlNode* frozen = map.optional("frozen_limit_ms")) {
    keys_.frozen_limit_ns =
        quantities_.milliseconds(*frozen, "the frozen limit", kPositive).value_or(0);
  }
  if (const YamlNode* source = map.optional("source")) {
    keys_.limits.source = read_source(*source, diagnostics_).value_or("");
  }
  if (const YamlNode* groups = map.optional("groups")) {
    static_cast<void>(read_groups(*groups, keys_.groups, diagnostics_));
  }
  if (keys_.person_node != nullptr)
    keys_.person = read_person(*keys_.person_node, keys_.name, map, quantities_);
  read_part_limits(map, quantities_, keys_.limits.mesh_limits);
  map.refuse_unknown_keys();
  return std::move(keys_);
}

}  // namespace

RobotKeys read_robot_keys(const YamlNode& node, const ObjectDefaults& defaults,
                          const RobotFolders& folders, const Quantities& quantities) {
  return RobotKeysReader(node, defaults, folders, quantities).read();
}

}  // namespace clearance
