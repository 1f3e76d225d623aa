#include "config/cell/planning_scene_reader.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <variant>

#include "config/text/printable.hpp"
#include "config/urdf/planning_scene.hpp"
#include "config/yaml/map_reader.hpp"

namespace clearance {
namespace {

// Reads the objects of one file; returns none after a diagnostic.
std::vector<Object> objects_of(const YamlNode& file_node, const std::filesystem::path& directory,
                               Revision& revision, Diagnostics& diagnostics) {
  const auto name = read_text(file_node, "a file", diagnostics);
  if (!name) return {};
  const std::filesystem::path path = path_in(revision.root(), directory, *name);
  const auto bytes = revision.read(path, *name);
  if (const auto* fault = std::get_if<FileFault>(&bytes)) {
    diagnostics.add(file_node, fmt::format("found a file that cannot be used: {}; expected a path "
                                           "relative to the cell file",
                                           fault->reason));
    return {};
  }
  revision.add_file(path, std::get<std::string>(bytes));
  auto read = read_planning_scene(std::get<std::string>(bytes));
  if (const auto* fault = std::get_if<PlanningSceneFault>(&read)) {
    diagnostics.add(file_node, fmt::format("found a planning scene that cannot be used: {}:{}: {}",
                                           *name, fault->line, excerpt(fault->reason)));
    return {};
  }
  std::vector<Object> objects = std::get<PlanningScene>(std::move(read)).objects;
  if (objects.empty())
    diagnostics.add(file_node, "found a planning scene without objects; expected some");
  return objects;
}

void read_scene(const YamlNode& node, const std::filesystem::path& directory,
                const ObjectDefaults& defaults, const Quantities& quantities, Revision& revision,
                ObjectList& list) {
  Diagnostics& diagnostics = quantities.diagnostics();
  MapReader map(node, "a planning scene", diagnostics);
  const YamlNode* file = map.required("file");
  const YamlNode* group_node = map.required("group");
  const YamlNode* pose_node = map.optional("pose");
  map.refuse_unknown_keys();
  const auto group = group_node == nullptr
                         ? std::nullopt
                         : read_name(*group_node, "the group of its objects", diagnostics);
  const Pose pose = pose_node == nullptr ? Pose{} : quantities.pose(*pose_node).value_or(Pose{});
  std::vector<Object> objects;
  if (file != nullptr) objects = objects_of(*file, directory, revision, diagnostics);
  if (objects.empty() || !group) list.names_known = false;
  for (Object& object : objects) {
    YamlNode name = *file;
    name.text = object.name;
    name.quoted = true;
    static_cast<void>(read_name(name, "the name of an object of a planning scene", diagnostics));
    if (group) object.groups = {*group};
    object.margin = defaults.margin;
    object.world_from_object = compose(pose, object.world_from_object);
    list.objects.push_back(std::move(object));
    list.places.push_back(file);
  }
}

}  // namespace

void read_planning_scenes(const YamlNode& node, const std::filesystem::path& directory,
                          const ObjectDefaults& defaults, const Quantities& quantities,
                          Revision& revision, ObjectList& list) {
  for (const YamlNode& item : read_list(node, "planning scenes", quantities.diagnostics()))
    read_scene(item, directory, defaults, quantities, revision, list);
  if (list.objects.size() <= kMaxObjects) return;
  quantities.diagnostics().add(
      node, fmt::format("found {} objects with those of planning scenes; expected at most {}",
                        list.objects.size(), kMaxObjects));
}

}  // namespace clearance
