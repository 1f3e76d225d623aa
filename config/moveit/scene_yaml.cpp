// One function for each type of message. A field that is missing keeps the default of ROS 2; a
// field of another name would be one that is missing in silence, and is refused.
#include "config/moveit/scene_yaml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"
#include "config/text/words.hpp"
#include "config/yaml/scalar.hpp"
#include "config/yaml/yaml_writer.hpp"

namespace clearance::moveit {
namespace {

// Thrown and caught inside this file.
struct ReadingEnds {
  SceneYamlFault fault;
};
[[noreturn]] void fail(const YamlNode& at, std::string reason) {
  throw ReadingEnds{{at.line, at.column, std::move(reason)}};
}

// The fields of each type of message, separated by blanks, of moveit_msgs and what it is made of.
struct Fields {
  std::string_view type, names;
};
constexpr std::array<Fields, 22> kFields = {{
    {"AllowedCollisionEntry", "enabled"},
    {"AllowedCollisionMatrix", "entry_names entry_values default_entry_names default_entry_values"},
    {"AttachedCollisionObject", "link_name object touch_links detach_posture weight"},
    {"CollisionObject",
     "header pose id type primitives primitive_poses meshes mesh_poses planes plane_poses "
     "subframe_names subframe_poses operation"},
    {"Header", "seq stamp frame_id"},
    {"LinkPadding", "link_name padding"},
    {"LinkScale", "link_name scale"},
    {"Mesh", "triangles vertices"},
    {"MeshTriangle", "vertex_indices"},
    {"Octomap", "header binary id resolution data"},
    {"OctomapWithPose", "header origin octomap"},
    {"Plane", "coef"},
    {"PlanningScene",
     "name robot_state robot_model_name fixed_frame_transforms allowed_collision_matrix "
     "link_padding link_scale object_colors world is_diff"},
    {"PlanningSceneWorld", "collision_objects octomap"},
    {"Point", "x y z"},
    {"Polygon", "points"},
    {"Pose", "position orientation"},
    {"Quaternion", "x y z w"},
    {"RobotState", "joint_state multi_dof_joint_state attached_collision_objects is_diff"},
    {"SolidPrimitive", "type dimensions polygon"},
    {"Transform", "translation rotation"},
    {"TransformStamped", "header child_frame_id transform"},
}};

// Checks the names of all fields of a message.
void check_fields(const YamlNode& map, std::string_view type) {
  if (map.kind != YamlNode::Kind::kMap)
    fail(map, fmt::format("found {}; expected the fields of a {}", describe(map), type));
  const auto fields = std::ranges::find(kFields, type, &Fields::type);
  for (const YamlEntry& entry : map.entries) {
    if (!has_word(fields->names, entry.key.text)) {
      const std::vector<std::string> known = words_of(fields->names);
      fail(entry.key, fmt::format("found '{}' in a {}; expected {}{}", entry.key.text, type,
                                  one_of(known), did_you_mean(entry.key.text, known)));
    }
    if (clearance::find(map, entry.key.text) != &entry.value)
      fail(entry.key, fmt::format("found '{}' in a {} again", entry.key.text, type));
  }
}

const YamlNode* field(const YamlNode& map, const char* name, const char* type) {
  check_fields(map, type);
  return clearance::find(map, name);
}

// Templates below find these by name only.
double read(const YamlNode& node, const double&);
std::uint32_t read(const YamlNode& node, const std::uint32_t&);
std::uint8_t read(const YamlNode& node, const std::uint8_t&);
bool read(const YamlNode& node, const bool&);
std::string read(const YamlNode& node, const std::string&);
Vec3 read(const YamlNode& node, const Vec3&);
Vec2 read(const YamlNode& node, const Vec2&);
Eigen::Quaterniond read(const YamlNode& node, const Eigen::Quaterniond&);
Pose read(const YamlNode& node, const Pose&);
SolidPrimitive read(const YamlNode& node, const SolidPrimitive&);
Mesh read(const YamlNode& node, const Mesh&);
CollisionObject read(const YamlNode& node, const CollisionObject&);
AttachedCollisionObject read(const YamlNode& node, const AttachedCollisionObject&);
FixedFrame read(const YamlNode& node, const FixedFrame&);
template <class T, std::size_t kCount>
std::array<T, kCount> read(const YamlNode& node, const std::array<T, kCount>&);
template <class T>
std::vector<T> read(const YamlNode& node, const std::vector<T>&);

double read(const YamlNode& node, const double&) {
  double value = 0.0;
  const std::string& text = node.text;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (node.kind != YamlNode::Kind::kScalar || node.quoted || result.ec != std::errc() ||
      result.ptr != text.data() + text.size()) {
    fail(node, fmt::format("found {}; expected a number", describe(node)));
  }
  return value;
}

std::uint32_t read(const YamlNode& node, const std::uint32_t&) {
  const double value = read(node, double());
  constexpr double kMost = std::numeric_limits<std::uint32_t>::max();
  if (!(value >= 0.0 && value <= kMost) || value != static_cast<std::uint32_t>(value))
    fail(node, fmt::format("found {}; expected a whole number", node.text));
  return static_cast<std::uint32_t>(value);
}

// Tools of ROS 2 print a `byte` as a text of this one byte: "\x03".
std::uint8_t read(const YamlNode& node, const std::uint8_t&) {
  if (node.kind == YamlNode::Kind::kScalar && node.quoted && node.text.size() == 1)
    return static_cast<std::uint8_t>(node.text.front());
  const std::uint32_t value = read(node, std::uint32_t());
  if (value > std::numeric_limits<std::uint8_t>::max())
    fail(node, fmt::format("found {}; expected 0 to 255", value));
  return static_cast<std::uint8_t>(value);
}

bool read(const YamlNode& node, const bool&) {
  if (node.kind == YamlNode::Kind::kScalar && !node.quoted) {
    if (node.text == "true" || node.text == "1") return true;
    if (node.text == "false" || node.text == "0") return false;
  }
  fail(node, fmt::format("found {}; expected true or false", describe(node)));
}

std::string read(const YamlNode& node, const std::string&) {
  if (node.kind == YamlNode::Kind::kNull) return "";
  if (node.kind != YamlNode::Kind::kScalar)
    fail(node, fmt::format("found {}; expected a text", describe(node)));
  return node.text;
}

template <class T>
void get(const YamlNode& map, const char* name, const char* type, T& value) {
  if (const YamlNode* node = field(map, name, type)) value = read(*node, T());
}

const std::vector<YamlNode>& items_of(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::kSequence && node.kind != YamlNode::Kind::kNull)
    fail(node, fmt::format("found {}; expected a list", describe(node)));
  return node.items;
}

// Reads a list of messages of which one field counts.
template <class T>
void get_each(const YamlNode& map, const char* name, const char* type, const char* item_field,
              const char* item_type, std::vector<T>& values) {
  const YamlNode* list = field(map, name, type);
  if (list == nullptr) return;
  for (const YamlNode& item : items_of(*list))
    get(item, item_field, item_type, values.emplace_back());
}

Vec3 read(const YamlNode& node, const Vec3&) {
  Vec3 point = Vec3::Zero();
  get(node, "x", "Point", point.x());
  get(node, "y", "Point", point.y());
  get(node, "z", "Point", point.z());
  return point;
}

Vec2 read(const YamlNode& node, const Vec2&) { return read(node, Vec3()).head<2>(); }

Eigen::Quaterniond read(const YamlNode& node, const Eigen::Quaterniond&) {
  Eigen::Quaterniond turn = Pose{}.orientation;
  get(node, "x", "Quaternion", turn.x());
  get(node, "y", "Quaternion", turn.y());
  get(node, "z", "Quaternion", turn.z());
  get(node, "w", "Quaternion", turn.w());
  return turn;
}

Pose read(const YamlNode& node, const Pose&) {
  Pose pose;
  get(node, "position", "Pose", pose.position);
  get(node, "orientation", "Pose", pose.orientation);
  return pose;
}

template <class T, std::size_t kCount>
std::array<T, kCount> read(const YamlNode& node, const std::array<T, kCount>&) {
  if (node.kind != YamlNode::Kind::kSequence || node.items.size() != kCount)
    fail(node, fmt::format("found {}; expected a list of {}", describe(node), kCount));
  std::array<T, kCount> values;
  for (std::size_t i = 0; i < kCount; ++i) values[i] = read(node.items[i], T());
  return values;
}

SolidPrimitive read(const YamlNode& node, const SolidPrimitive&) {
  SolidPrimitive primitive;
  get(node, "type", "SolidPrimitive", primitive.type);
  get(node, "dimensions", "SolidPrimitive", primitive.dimensions);
  if (const YamlNode* polygon = field(node, "polygon", "SolidPrimitive"))
    get(*polygon, "points", "Polygon", primitive.polygon);
  return primitive;
}

Mesh read(const YamlNode& node, const Mesh&) {
  Mesh mesh;
  get_each(node, "triangles", "Mesh", "vertex_indices", "MeshTriangle", mesh.triangles);
  get(node, "vertices", "Mesh", mesh.vertices);
  return mesh;
}

std::string frame_of(const YamlNode& node, const char* type) {
  std::string frame;
  if (const YamlNode* header = field(node, "header", type))
    get(*header, "frame_id", "Header", frame);
  return frame;
}

CollisionObject read(const YamlNode& node, const CollisionObject&) {
  constexpr const char* kType = "CollisionObject";
  CollisionObject object;
  object.frame_id = frame_of(node, kType);
  get(node, "pose", kType, object.pose);
  get(node, "id", kType, object.id);
  get(node, "primitives", kType, object.primitives);
  get(node, "primitive_poses", kType, object.primitive_poses);
  get(node, "meshes", kType, object.meshes);
  get(node, "mesh_poses", kType, object.mesh_poses);
  get_each(node, "planes", kType, "coef", "Plane", object.planes);
  get(node, "plane_poses", kType, object.plane_poses);
  get(node, "subframe_names", kType, object.subframe_names);
  get(node, "subframe_poses", kType, object.subframe_poses);
  get(node, "operation", kType, object.operation);
  return object;
}

AttachedCollisionObject read(const YamlNode& node, const AttachedCollisionObject&) {
  constexpr const char* kType = "AttachedCollisionObject";
  AttachedCollisionObject attached;
  get(node, "link_name", kType, attached.link_name);
  get(node, "object", kType, attached.object);
  get(node, "touch_links", kType, attached.touch_links);
  get(node, "weight", kType, attached.weight);
  return attached;
}

FixedFrame read(const YamlNode& node, const FixedFrame&) {
  constexpr const char* kType = "TransformStamped";
  FixedFrame frame;
  frame.frame_id = frame_of(node, kType);
  get(node, "child_frame_id", kType, frame.child_frame_id);
  if (const YamlNode* transform = field(node, "transform", kType)) {
    get(*transform, "translation", "Transform", frame.child_from_frame.position);
    get(*transform, "rotation", "Transform", frame.child_from_frame.orientation);
  }
  return frame;
}

template <class T>
std::vector<T> read(const YamlNode& node, const std::vector<T>&) {
  std::vector<T> list;
  for (const YamlNode& item : items_of(node)) list.push_back(read(item, T()));
  return list;
}

// A cell states margins, and its URDF the size of a link.
void refuse_other_sizes(const YamlNode& scene, const char* name, const char* type,
                        const char* value_name, double neutral) {
  const YamlNode* list = field(scene, name, "PlanningScene");
  if (list == nullptr) return;
  for (const YamlNode& item : items_of(*list)) {
    double value = neutral;
    get(item, value_name, type, value);
    if (value != neutral)
      fail(item, fmt::format("found a {} of {}, which is not read; expected {} (a cell states "
                             "'margins')",
                             value_name, value, neutral));
  }
}

// The frame of the octomap would be needed, too.
void refuse_octomap(const YamlNode& world) {
  const YamlNode* with_pose = field(world, "octomap", "PlanningSceneWorld");
  if (with_pose == nullptr) return;
  const YamlNode* octomap = field(*with_pose, "octomap", "OctomapWithPose");
  const YamlNode* data = octomap == nullptr ? nullptr : field(*octomap, "data", "Octomap");
  if (data != nullptr && !data->items.empty())
    fail(*data,
         "found an octomap, which is not read; expected none ('sensors' takes octomaps from "
         "ROS 2)");
}

PlanningScene read(const YamlNode& node, const PlanningScene&) {
  constexpr const char* kType = "PlanningScene";
  PlanningScene scene;
  get(node, "name", kType, scene.name);
  get(node, "is_diff", kType, scene.is_diff);
  get(node, "fixed_frame_transforms", kType, scene.fixed_frame_transforms);
  if (const YamlNode* state = field(node, "robot_state", kType)) {
    get(*state, "attached_collision_objects", "RobotState", scene.attached);
    get(*state, "is_diff", "RobotState", scene.robot_state_is_diff);
  }
  if (const YamlNode* matrix = field(node, "allowed_collision_matrix", kType)) {
    constexpr const char* kMatrix = "AllowedCollisionMatrix";
    AllowedCollisionMatrix& to = scene.allowed_collision_matrix;
    get(*matrix, "entry_names", kMatrix, to.entry_names);
    get_each(*matrix, "entry_values", kMatrix, "enabled", "AllowedCollisionEntry", to.entry_values);
    get(*matrix, "default_entry_names", kMatrix, to.default_entry_names);
    get(*matrix, "default_entry_values", kMatrix, to.default_entry_values);
  }
  const YamlNode* world = field(node, "world", kType);
  if (world == nullptr)
    fail(node, "found no 'world'; expected the fields of a moveit_msgs/PlanningScene");
  get(*world, "collision_objects", "PlanningSceneWorld", scene.collision_objects);
  refuse_octomap(*world);
  refuse_other_sizes(node, "link_padding", "LinkPadding", "padding", 0.0);
  refuse_other_sizes(node, "link_scale", "LinkScale", "scale", 1.0);
  return scene;
}

}  // namespace

std::variant<PlanningScene, SceneYamlFault> read_scene_yaml(const std::string& text) {
  constexpr std::string_view kEnd = "\n---";
  const std::size_t length = text.find(kEnd, 1);
  if (length != std::string::npos) {
    const std::size_t second = text.find_first_not_of("- \t\r\n.", length);
    if (second != std::string::npos)
      return SceneYamlFault{static_cast<int>(1 + std::ranges::count(text.substr(0, second), '\n')),
                            1, "found a second document; expected one message"};
  }
  const auto read_text =
      parse_yaml(length == std::string::npos ? text : text.substr(0, length + 1));
  if (const auto* fault = std::get_if<YamlFault>(&read_text))
    return SceneYamlFault{fault->line, fault->column, fault->reason};
  try {
    return read(std::get<YamlNode>(read_text), PlanningScene());
  } catch (ReadingEnds& end) {
    return std::move(end.fault);
  }
}

}  // namespace clearance::moveit
