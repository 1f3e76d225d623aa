#include "config/cell/robot_description.hpp"
#include "config/scene/body_id.hpp"

#include <fmt/format.h>

#include <utility>
#include <variant>

#include "config/cell/link_parts.hpp"
#include "config/text/file_bytes.hpp"
#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"
#include "config/urdf/person.hpp"
#include "config/urdf/robot_exceptions.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {

std::optional<std::filesystem::path> find_robot_file(const YamlNode& node, const RobotFiles& files,
                                                     Diagnostics& diagnostics, Revision& revision) {
  const auto name = read_text(node, "a file", diagnostics);
  if (!name) return std::nullopt;
  const auto path = files.find(*name);
  if (!path) {
    diagnostics.add(node, fmt::format("found '{}', and {}", *name,
                                      files.why_not_found(*name, packages_from(diagnostics))));
    return std::nullopt;
  }
  const auto bytes = revision.read(*path, *name);
  if (const auto* fault = std::get_if<FileFault>(&bytes)) {
    diagnostics.add(node,
                    fmt::format("found a file that cannot be used: {}; expected {}", fault->reason,
                                diagnostics.is_of_urdf() ? "a robot's URDF, and its SRDF"
                                                         : "a path relative to the cell file"));
    return std::nullopt;
  }
  revision.add_file(*path, std::get<std::string>(bytes));
  return path;
}

namespace {

// Refuses a name whose visual shapes did not become collision shapes.
void refuse_other_links(const YamlNode& name, const UrdfRobot& robot, Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (const UrdfLink& link : robot.links) {
    if (link.name == name.text && link.has_visual && !link.has_collision) return;
    if (link.has_visual && !link.has_collision) names.push_back(link.name);
  }
  diagnostics.add(
      name, fmt::format("found '{}'; expected a link with a visual and no collision shape{}{}",
                        name.text, names.empty() ? ", and there is none" : ": " + one_of(names),
                        did_you_mean(name.text, names)));
}

// Makes the tree of joints. Returns nothing after a diagnostic.
std::optional<RobotDescription> complete(const DescriptionKeys& keys, RobotDescription& description,
                                         Diagnostics& diagnostics) {
  const DescribedPerson& person = keys.person;
  const YamlNode& at = keys.urdf != nullptr ? *keys.urdf : *person.node;
  if (person.node != nullptr) {
    if (auto missing = make_person(person.stature, person.name, body_name(person.id, person.name),
                                   description.robot)) {
      diagnostics.add(
          at, fmt::format("found {}; expected the skeleton of ROS4HRI (REP-155)", *missing));
      return std::nullopt;
    }
  }
  auto model = robot_model(description.robot, description.urdf, keys.prefix);
  if (const auto* faults = std::get_if<UrdfFaults>(&model)) {
    refuse_robot(at, *faults, diagnostics);
    return std::nullopt;
  }
  description.model = std::get<RobotModel>(std::move(model));
  return std::move(description);
}

// Without a URDF of the tracker, the lengths of limbs follow from the stature.
std::optional<RobotDescription> read_own_skeleton(const DescriptionKeys& keys,
                                                  Diagnostics& diagnostics) {
  RobotDescription description;
  description.robot = skeleton_of(keys.person.stature);
  return complete(keys, description, diagnostics);
}

}  // namespace

// Both files are read even if the first has faults, so that one run reports all.
std::optional<RobotDescription> read_description(const DescriptionKeys& keys,
                                                 Diagnostics& diagnostics, Revision& revision) {
  if (keys.urdf == nullptr) {
    return keys.person.node == nullptr ? std::nullopt : read_own_skeleton(keys, diagnostics);
  }
  RobotDescription description;
  const auto urdf = find_robot_file(*keys.urdf, keys.files, diagnostics, revision);
  const auto srdf = keys.srdf == nullptr
                        ? std::nullopt
                        : find_robot_file(*keys.srdf, keys.files, diagnostics, revision);
  const std::size_t before = diagnostics.count();
  if (srdf) {
    auto read = read_srdf(*srdf);
    if (const auto* faults = std::get_if<UrdfFaults>(&read))
      refuse_robot(*keys.srdf, *faults, diagnostics);
    if (auto* good = std::get_if<Srdf>(&read)) description.srdf = std::move(*good);
  }
  if (!urdf || (keys.srdf != nullptr && !srdf)) return std::nullopt;
  description.urdf = *urdf;
  std::vector<std::string> by_visual;
  for (const YamlNode* each : keys.visual_as_collision) by_visual.push_back(each->text);
  auto read =
      read_urdf(*urdf, by_visual, keys.person.node != nullptr ? UrdfOf::kSkeleton : UrdfOf::kRobot);
  if (const auto* faults = std::get_if<UrdfFaults>(&read)) {
    refuse_robot(*keys.urdf, *faults, diagnostics);
    return std::nullopt;
  }
  description.robot = std::get<UrdfRobot>(std::move(read));
  for (const YamlNode* each : keys.visual_as_collision)
    refuse_other_links(*each, description.robot, diagnostics);
  if (description.srdf) {
    refuse_robot(*keys.srdf, faults_of(*description.srdf, *srdf, description.robot, *urdf),
                 diagnostics);
  }
  auto completed = complete(keys, description, diagnostics);
  return diagnostics.count() == before ? std::move(completed) : std::nullopt;
}

}  // namespace clearance
