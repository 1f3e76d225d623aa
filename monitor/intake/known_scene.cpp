#include "monitor/intake/known_scene.hpp"

#include <algorithm>
#include <variant>

#include "config/scene/people.hpp"
#include "config/yaml/diagnostics.hpp"
#include "config/yaml/quantity_nodes.hpp"
#include "config/yaml/yaml_writer.hpp"

namespace clearance::moveit {
namespace {

std::string text_of(const YamlNode* node) { return node == nullptr ? "" : node->text; }

const std::vector<YamlNode>& items_of(const YamlNode& cell, std::string_view list) {
  static const std::vector<YamlNode> kNone;
  const YamlNode* node = find(cell, list);
  return node == nullptr ? kNone : node->items;
}

bool names(const YamlNode* list, const std::string& name) {
  return list != nullptr &&
         std::ranges::find(list->items, name, &YamlNode::text) != list->items.end();
}

// Returns nothing where a joint, an object or a frame of tf moves the link.
std::optional<Pose> pose_at_rest(const Robot& robot, std::uint32_t link) {
  Pose root_from_link;
  while (link > 0) {
    const RobotJoint& joint = robot.joints[link - 1];
    if (joint.type != JointType::kFixed) return std::nullopt;
    root_from_link = compose(joint.parent_from_joint, root_from_link);
    link = joint.parent;
  }
  if (robot.base.kind != RobotBase::Kind::kWorld || !robot.base.frame.empty()) return std::nullopt;
  return compose(robot.base.base_from_root, root_from_link);
}

// Takes an object's entry from the text of the cell, which the reader has accepted.
void add_entry(const YamlNode& entry, const YamlNode& cell, KnownScene& scene) {
  const auto found = scene.objects.find(text_of(find(entry, "name")));
  if (found == scene.objects.end()) return;
  KnownObject& object = found->second;
  object.is_in_objects = true;
  object.is_moveits = names(find(entry, "groups"), scene.group);
  object.entry = entry;
  const YamlNode* attached = find(entry, "attached");
  if (attached == nullptr) return;
  object.where = KnownObject::Where::kAttached;
  object.carrier = text_of(find(*attached, "to"));
  object.pose = {};
  if (const YamlNode* pose = find(*attached, "pose")) {
    Diagnostics none("");
    const YamlNode* units = find(cell, "units");
    const bool is_degrees = units != nullptr && text_of(find(*units, "angle")) == "deg";
    const Units stated{scene.unit, is_degrees ? AngleUnit::kDegree : AngleUnit::kRadian};
    object.pose = Quantities(stated, none).pose(*pose).value_or(Pose{});
  }
}

}  // namespace

NamePair name_pair(const std::string& a, const std::string& b) { return std::minmax(a, b); }

std::set<NamePair> watched_pairs(const Scene& scene) {
  std::set<NamePair> pairs;
  for (const auto& [first, second, publish] : scene.pairs) {
    if (!contact_with_people(scene.objects, scene.robots, {}, {}, first, second))
      pairs.insert(name_pair(scene.objects[first].name, scene.objects[second].name));
  }
  return pairs;
}

KnownScene known_scene(const Cell& cell) {
  KnownScene known;
  known.world = cell.ros.world();
  known.group = cell.ros.moveit.group;
  const Scene& scene = cell.scene;
  for (const Object& object : scene.objects) {
    KnownObject& added = known.objects[object.name];
    added.where = object.fixed ? KnownObject::Where::kFixed : KnownObject::Where::kMoving;
    added.pose = object.world_from_object;
    added.margin = object.margin;
  }
  for (const Robot& robot : scene.robots) {
    if (!robot.is_attached) known.robots[robot.name].root = robot.links.front().name;
    for (std::uint32_t i = 0; i < robot.links.size() && !robot.is_attached; ++i) {
      const RobotLink& link = robot.links[i];
      known.links[link.name] = pose_at_rest(robot, i);
      if (link.object != RobotLink::kNoObject)
        known.objects[link.name].where = KnownObject::Where::kLink;
    }
  }
  known.watched = watched_pairs(scene);
  known.has_octomap_sensor = std::ranges::any_of(
      scene.sensors, [](const Sensor& sensor) { return sensor.kind == SensorKind::kOctomap; });
  const auto read = parse_yaml(cell.yaml);
  const auto* tree = std::get_if<YamlNode>(&read);
  if (tree == nullptr) return known;
  known.unit = length_unit_of(*tree);
  for (const YamlNode& entry : items_of(*tree, "objects")) add_entry(entry, *tree, known);
  for (const YamlNode& entry : items_of(*tree, "robots")) {
    const auto robot = known.robots.find(text_of(find(entry, "name")));
    const YamlNode* attached = find(entry, "attached");
    if (robot != known.robots.end() && attached != nullptr)
      robot->second.carrier = text_of(find(*attached, "to"));
  }
  for (const YamlNode& entry : items_of(*tree, "margins"))
    known.margins.insert(text_of(find(entry, "name")));
  for (const YamlNode& entry : items_of(*tree, "allowed_collisions")) {
    const YamlNode* between = find(entry, "between");
    if (between == nullptr || between->items.size() != 2) continue;
    if (text_of(find(entry, "reason")) != kMatrixReason) continue;
    known.exceptions.insert(name_pair(between->items[0].text, between->items[1].text));
  }
  return known;
}

}  // namespace clearance::moveit
