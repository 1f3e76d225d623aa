#include "config/cell/planning_scene_reader.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>

#include "config/cell/object_parts.hpp"
#include "config/moveit/object_entry.hpp"
#include "config/moveit/scene_yaml.hpp"
#include "config/text/printable.hpp"
#include "config/urdf/planning_scene.hpp"
#include "config/yaml/map_reader.hpp"
#include "config/yaml/yaml_writer.hpp"

namespace clearance {
namespace {

// A fault in a file that the cell names.
struct FileMistake {
  int line;  // 0: none
  std::string reason;
  int column = 0;  // 0: not known
};

// Gives generated nodes the place of the file's name in the cell.
void place_at(const YamlNode& place, YamlNode& node) {
  node.line = place.line;
  node.column = place.column;
  for (YamlNode& item : node.items) place_at(place, item);
  for (YamlEntry& entry : node.entries) {
    place_at(place, entry.key);
    place_at(place, entry.value);
  }
}

// The content of a planning scene, without groups and margins.
struct ReadScene {
  std::vector<Object> objects;
  std::vector<std::pair<Object, YamlNode>> attached;  // with the value of `attached`
  std::optional<moveit::CollisionMatrix> matrix;
};

// Reads planning scenes, one file after another.
class PlanningSceneReader {
 public:
  PlanningSceneReader(const std::filesystem::path& directory, const Quantities& quantities,
                      ShapeReader& shapes, Revision& revision)
      : directory_(directory),
        quantities_(quantities),
        diagnostics_(quantities.diagnostics()),
        parts_(quantities, shapes),
        revision_(revision) {}

  // Returns an empty one after a diagnostic.
  ReadScene scene_of(const YamlNode& file_node);

 private:
  using Read = std::variant<ReadScene, FileMistake>;
  static Read scene_of_text(const std::string& text);
  Read scene_of_yaml(const std::string& text, const YamlNode& file_node);
  std::optional<FileMistake> add_attached(const std::vector<moveit::AttachedCollisionObject>& list,
                                          const YamlNode& file_node, ReadScene& scene);
  std::variant<Object, FileMistake> object_of(const moveit::CollisionObject& message,
                                              const Pose& scene_from_frame, const std::string& path,
                                              const YamlNode& file_node);

  const std::filesystem::path& directory_;
  const Quantities& quantities_;
  Diagnostics& diagnostics_;
  ObjectPartsReader parts_;
  Revision& revision_;
};

PlanningSceneReader::Read PlanningSceneReader::scene_of_text(const std::string& text) {
  auto read = read_planning_scene(text);
  if (auto* fault = std::get_if<PlanningSceneFault>(&read))
    return FileMistake{fault->line, std::move(fault->reason)};
  return ReadScene{std::get<PlanningScene>(std::move(read)).objects, {}, {}};
}

std::variant<Object, FileMistake> PlanningSceneReader::object_of(
    const moveit::CollisionObject& message, const Pose& scene_from_frame, const std::string& path,
    const YamlNode& file_node) {
  if (message.operation != static_cast<std::uint8_t>(moveit::Operation::kAdd)) {
    return FileMistake{
        0, fmt::format("{}.operation: found {}; expected 0 (ADD)", path, message.operation)};
  }
  auto made = moveit::body_of(message, quantities_.units().length, moveit::MeshForm::kHull);
  if (const auto* fault = std::get_if<moveit::FieldFault>(&made))
    return FileMistake{0, fmt::format("{}.{}: {}", path, fault->field, fault->reason)};
  auto& body = std::get<moveit::Body>(made);
  Object object;
  object.name = message.id;
  object.fixed = true;
  object.max_speed = 0.0;
  object.world_from_object = compose(scene_from_frame, body.frame_from_object);
  YamlNode node;
  set(node, "parts", std::move(body.parts));
  place_at(file_node, node);
  MapReader map(node, "an object of a planning scene", diagnostics_);
  static_cast<void>(parts_.read(map, node, object));
  return object;
}

// No file says where a link is in the world: an attached body has to be in the frame of its link.
std::optional<FileMistake> PlanningSceneReader::add_attached(
    const std::vector<moveit::AttachedCollisionObject>& list, const YamlNode& file_node,
    ReadScene& scene) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    const moveit::AttachedCollisionObject& message = list[i];
    const std::string path = fmt::format("robot_state.attached_collision_objects[{}].object", i);
    if (message.object.frame_id != message.link_name) {
      return FileMistake{
          0, fmt::format("{}.header.frame_id: found '{}'; expected '{}', the link "
                         "that carries '{}'",
                         path, message.object.frame_id, message.link_name, message.object.id)};
    }
    auto object = object_of(message.object, Pose{}, path, file_node);
    if (auto* mistake = std::get_if<FileMistake>(&object)) return std::move(*mistake);
    auto& made = std::get<Object>(object);
    made.fixed = false;
    made.max_speed = kInfinity;
    made.mass = moveit::mass_of(message.weight).value_or(kInfinity);
    const YamlNode entry = moveit::attached_entry(
        made.name, "", {message.link_name, made.world_from_object, message.touch_links}, {},
        quantities_.units().length);
    YamlNode attached = *find(entry, "attached");
    place_at(file_node, attached);
    scene.attached.emplace_back(std::move(made), std::move(attached));
  }
  return std::nullopt;
}

// The poses of all objects are in one frame, that of the first object, or in a fixed frame that the
// scene places in that one.
PlanningSceneReader::Read PlanningSceneReader::scene_of_yaml(const std::string& text,
                                                             const YamlNode& file_node) {
  auto read = moveit::read_scene_yaml(text);
  if (auto* fault = std::get_if<moveit::SceneYamlFault>(&read))
    return FileMistake{fault->line, std::move(fault->reason), fault->column};
  const auto& scene = std::get<moveit::PlanningScene>(read);
  ReadScene made;
  if (auto mistake = add_attached(scene.attached, file_node, made)) return *std::move(mistake);
  if (!scene.allowed_collision_matrix.entry_names.empty() ||
      !scene.allowed_collision_matrix.default_entry_names.empty()) {
    const auto fault = made.matrix.emplace().set(scene.allowed_collision_matrix);
    if (fault) {
      return FileMistake{
          0, fmt::format("allowed_collision_matrix.{}: {}", fault->field, fault->reason)};
    }
  }
  struct Placed {
    std::string in;
    Pose pose;
  };
  std::map<std::string, Placed> frames;
  for (const moveit::FixedFrame& frame : scene.fixed_frame_transforms) {
    auto pose = moveit::checked_pose(frame.child_from_frame, "fixed_frame_transforms");
    if (const auto* fault = std::get_if<moveit::FieldFault>(&pose))
      return FileMistake{0, fault->field + ": " + fault->reason};
    frames[frame.frame_id] = {frame.child_frame_id, std::get<Pose>(pose)};
  }
  const std::string first =
      scene.collision_objects.empty() ? "" : scene.collision_objects[0].frame_id;
  const std::string base = frames.contains(first) ? frames[first].in : first;
  for (std::size_t i = 0; i < scene.collision_objects.size(); ++i) {
    const moveit::CollisionObject& message = scene.collision_objects[i];
    const std::string path = fmt::format("world.collision_objects[{}]", i);
    const auto frame = frames.find(message.frame_id);
    if (frame == frames.end() && message.frame_id != base) {
      return FileMistake{0, fmt::format("{}.header.frame_id: found '{}'; expected '{}', or one of "
                                        "fixed_frame_transforms",
                                        path, message.frame_id, base)};
    }
    if (frame != frames.end() && frame->second.in != base) {
      return FileMistake{0, fmt::format("{}.header.frame_id: found '{}', which "
                                        "fixed_frame_transforms place in '{}'; expected a frame "
                                        "that they place in '{}'",
                                        path, message.frame_id, frame->second.in, base)};
    }
    auto object =
        object_of(message, frame == frames.end() ? Pose{} : frame->second.pose, path, file_node);
    if (auto* mistake = std::get_if<FileMistake>(&object)) return std::move(*mistake);
    made.objects.push_back(std::get<Object>(std::move(object)));
  }
  return made;
}

ReadScene PlanningSceneReader::scene_of(const YamlNode& file_node) {
  const auto name = read_text(file_node, "a file", diagnostics_);
  if (!name) return {};
  const std::filesystem::path path = path_in(revision_.root(), directory_, *name);
  const auto bytes = revision_.read(path, *name);
  if (const auto* fault = std::get_if<FileFault>(&bytes)) {
    diagnostics_.add(file_node, fmt::format("found a file that cannot be used: {}; expected a path "
                                            "relative to the cell file",
                                            fault->reason));
    return {};
  }
  const auto& text = std::get<std::string>(bytes);
  revision_.add_file(path, text);
  const bool is_yaml = path.extension() == ".yaml" || path.extension() == ".yml";
  auto read = is_yaml ? scene_of_yaml(text, file_node) : scene_of_text(text);
  if (const auto* mistake = std::get_if<FileMistake>(&read)) {
    const std::string place = mistake->line == 0 ? ""
                              : mistake->column == 0
                                  ? fmt::format("{}:", mistake->line)
                                  : fmt::format("{}:{}:", mistake->line, mistake->column);
    diagnostics_.add(file_node, fmt::format("found a planning scene that cannot be used: {}:{} {}",
                                            *name, place, excerpt(mistake->reason)));
    return {};
  }
  auto& scene = std::get<ReadScene>(read);
  if (scene.objects.empty() && scene.attached.empty())
    diagnostics_.add(file_node, "found a planning scene without objects; expected some");
  return std::move(scene);
}

void read_scene(const YamlNode& node, const ObjectDefaults& defaults, const Quantities& quantities,
                PlanningSceneReader& reader, ObjectList& list) {
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
  ReadScene scene;
  if (file != nullptr) scene = reader.scene_of(*file);
  if ((scene.objects.empty() && scene.attached.empty()) || !group) list.names_known = false;
  if (scene.matrix) list.matrices.emplace_back(*std::move(scene.matrix), file->line);
  const auto finish = [&](Object& object) {
    YamlNode name = *file;
    name.text = object.name;
    name.quoted = true;
    static_cast<void>(read_name(name, "the name of an object of a planning scene", diagnostics));
    if (group) object.groups = {*group};
    object.margin = defaults.margin;
  };
  for (Object& object : scene.objects) {
    finish(object);
    object.world_from_object = compose(pose, object.world_from_object);
    list.objects.push_back(std::move(object));
    list.places.push_back(file);
  }
  for (auto& [object, attached] : scene.attached) {
    finish(object);
    object.world_from_object = {};
    list.generated.push_back(std::move(attached));
    list.stated.push_back({std::move(object), file, &list.generated.back(), nullptr});
  }
}

}  // namespace

void read_planning_scenes(const YamlNode& node, const std::filesystem::path& directory,
                          const ObjectDefaults& defaults, const Quantities& quantities,
                          ShapeReader& shapes, Revision& revision, ObjectList& list) {
  PlanningSceneReader reader(directory, quantities, shapes, revision);
  for (const YamlNode& item : read_list(node, "planning scenes", quantities.diagnostics()))
    read_scene(item, defaults, quantities, reader, list);
  if (list.objects.size() <= kMaxObjects) return;
  quantities.diagnostics().add(
      node, fmt::format("found {} objects with those of planning scenes; expected at most {}",
                        list.objects.size(), kMaxObjects));
}

// A name of a matrix may be of a link without shapes, or of another robot: it then means nothing.
void allow_by_matrices(const ObjectList& list, PairExceptions& may_touch) {
  for (const auto& [matrix, line] : list.matrices) {
    const std::set<std::string> names = matrix.names();
    for (std::uint32_t i = 0; i < list.objects.size(); ++i) {
      if (!names.contains(list.objects[i].name)) continue;
      for (std::uint32_t j = 0; j < list.objects.size(); ++j) {
        if (i != j && matrix.allows(list.objects[i].name, list.objects[j].name))
          may_touch.emplace_back(pair_key(i, j), line);
      }
    }
  }
}

}  // namespace clearance
