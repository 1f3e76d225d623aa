#include "config/moveit/object_entry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <utility>

#include "config/decomposition/part_limits.hpp"
#include "config/decomposition/plate.hpp"
#include "config/scene/revision.hpp"
#include "config/yaml/quantity_nodes.hpp"
#include "config/yaml/yaml_writer.hpp"

namespace clearance::moveit {
namespace {

// Thrown inside this file only.
struct Fault {
  FieldFault fault;
};
[[noreturn]] void fail(std::string field, std::string reason) {
  throw Fault{{std::move(field), std::move(reason)}};
}

// Programs compute quaternions in single precision, and write them with six digits.
constexpr double kQuaternionTolerance = 1e-3;

Pose usable_pose(const Pose& pose, const std::string& field) {
  if (!pose.position.allFinite())
    fail(field + ".position", "found a number that is not finite; expected metres");
  const Eigen::Quaterniond& turn = pose.orientation;
  if (turn.coeffs() == Eigen::Vector4d::Zero()) return {pose.position, Pose{}.orientation};
  const double length = turn.norm();
  if (!(std::abs(length - 1.0) <= kQuaternionTolerance)) {
    fail(field + ".orientation",
         fmt::format("found a quaternion of length {:.6g}; expected 1", length));
  }
  return is_unit(turn) ? pose : Pose{pose.position, turn.normalized()};
}

bool is_identity(const Pose& pose) {
  return pose.position == Vec3::Zero() && pose.orientation.vec() == Vec3::Zero();
}

YamlNode empty(YamlNode::Kind kind) {
  YamlNode node;
  node.kind = kind;
  return node;
}

YamlNode named_entry(const std::string& name, const std::string& group) {
  YamlNode entry = empty(YamlNode::Kind::kMap);
  set(entry, "name", text_node(name));
  YamlNode groups = empty(YamlNode::Kind::kSequence);
  groups.items.push_back(text_node(group));
  set(entry, "groups", std::move(groups));
  return entry;
}

// Makes the parts of one object, one shape after another.
class PartsWriter {
 public:
  PartsWriter(const CollisionObject& object, LengthUnit unit, MeshForm meshes)
      : object_(object), unit_(unit), meshes_(meshes) {
    body_.parts.kind = YamlNode::Kind::kSequence;
  }

  Body write();

 private:
  template <class Shape, class Write>
  void write_shapes(const std::vector<Shape>& shapes, const std::vector<Pose>& poses,
                    const std::string& name, const Write& write);
  void add_part(const std::string& kind, YamlNode shape, const Pose& pose);
  void add_primitive(const SolidPrimitive& primitive, const Pose& pose, const std::string& field);
  void add_mesh(const Mesh& mesh, const Pose& pose, const std::string& field);
  void add_plane(const Plane& plane, const Pose& pose, const std::string& field);
  YamlNode hull_of(const Mesh& mesh) const;
  YamlNode file_of(const Mesh& mesh);
  void set_length(YamlNode& shape, const char* key, double metres) const {
    set(shape, key, length_node(metres, unit_));
  }

  const CollisionObject& object_;
  LengthUnit unit_;
  MeshForm meshes_;
  bool pose_is_the_shapes_ = false;  // the only shape has the pose of the object
  Body body_;
};

template <class Shape, class Write>
void PartsWriter::write_shapes(const std::vector<Shape>& shapes, const std::vector<Pose>& poses,
                               const std::string& name, const Write& write) {
  const std::string poses_name = (name == "primitives" ? "primitive"
                                  : name == "meshes"   ? "mesh"
                                                       : "plane") +
                                 std::string("_poses");
  if (poses.size() > shapes.size()) {
    fail(poses_name, fmt::format("found {} poses of {} {}; expected at most one for each",
                                 poses.size(), shapes.size(), name));
  }
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const Pose pose =
        i < poses.size() ? usable_pose(poses[i], fmt::format("{}[{}]", poses_name, i)) : Pose{};
    if (pose_is_the_shapes_) body_.frame_from_object = pose;
    write(shapes[i], pose_is_the_shapes_ ? Pose{} : pose, fmt::format("{}[{}]", name, i));
  }
}

Body PartsWriter::write() {
  body_.frame_from_object = usable_pose(object_.pose, "pose");
  pose_is_the_shapes_ = object_.shapes() == 1 && is_identity(body_.frame_from_object);
  write_shapes(object_.primitives, object_.primitive_poses, "primitives",
               [this](const auto& shape, const Pose& pose, const std::string& field) {
                 add_primitive(shape, pose, field);
               });
  write_shapes(object_.meshes, object_.mesh_poses, "meshes",
               [this](const auto& shape, const Pose& pose, const std::string& field) {
                 add_mesh(shape, pose, field);
               });
  write_shapes(object_.planes, object_.plane_poses, "planes",
               [this](const auto& shape, const Pose& pose, const std::string& field) {
                 add_plane(shape, pose, field);
               });
  return std::move(body_);
}

void PartsWriter::add_part(const std::string& kind, YamlNode shape, const Pose& pose) {
  YamlNode part = empty(YamlNode::Kind::kMap);
  set(part, kind, std::move(shape));
  if (!is_identity(pose)) set(part, "pose", pose_node(pose, unit_));
  body_.parts.items.push_back(std::move(part));
}

void PartsWriter::add_primitive(const SolidPrimitive& primitive, const Pose& pose,
                                const std::string& field) {
  struct Kind {
    const char* name;
    std::size_t dimensions;
    const char* expected;
  };
  static constexpr std::array<Kind, 6> kKinds = {{{"", 0, ""},
                                                  {"box", 3, "x, y, z"},
                                                  {"sphere", 1, "a radius"},
                                                  {"cylinder", 2, "a height and a radius"},
                                                  {"cone", 2, "a height and a radius"},
                                                  {"prism", 1, "a height"}}};
  if (primitive.type == 0 || primitive.type >= kKinds.size()) {
    fail(field + ".type", fmt::format("found {}; expected 1 (box), 2 (sphere), 3 (cylinder), 4 "
                                      "(cone) or 5 (prism)",
                                      primitive.type));
  }
  const Kind& kind = kKinds[primitive.type];
  const std::vector<double>& lengths = primitive.dimensions;
  if (lengths.size() != kind.dimensions || !std::ranges::all_of(lengths, [](double each) {
        return std::isfinite(each) && each > 0.0;
      })) {
    fail(field + ".dimensions", fmt::format("found [{}]; expected {} in m, above 0",
                                            fmt::join(lengths, ", "), kind.expected));
  }
  YamlNode shape = empty(YamlNode::Kind::kMap);
  switch (primitive.type) {
    case SolidPrimitive::kBox:
      set(shape, "size", lengths_node(lengths, unit_));
      break;
    case SolidPrimitive::kSphere:
      set_length(shape, "radius", lengths[0]);
      break;
    case SolidPrimitive::kPrism: {
      if (primitive.polygon.size() < 3 ||
          !std::ranges::all_of(primitive.polygon, [](const Vec2& at) { return at.allFinite(); })) {
        fail(field + ".polygon", fmt::format("found {} points; expected three or more, finite",
                                             primitive.polygon.size()));
      }
      YamlNode base = empty(YamlNode::Kind::kSequence);
      for (const Vec2& vertex : primitive.polygon)
        base.items.push_back(lengths_node({vertex.data(), 2}, unit_));
      set(shape, "base", std::move(base));
      const std::array<double, 2> z = {-0.5 * lengths[0], 0.5 * lengths[0]};
      set(shape, "z", lengths_node(z, unit_));
      break;
    }
    default:
      set_length(shape, "radius", lengths[1]);
      set_length(shape, "length", lengths[0]);
  }
  add_part(kind.name, std::move(shape), pose);
}

void PartsWriter::add_mesh(const Mesh& mesh, const Pose& pose, const std::string& field) {
  if (mesh.triangles.empty() || mesh.vertices.size() < 3) {
    fail(field, fmt::format("found {} triangles and {} vertices; expected a mesh",
                            mesh.triangles.size(), mesh.vertices.size()));
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!mesh.vertices[i].allFinite()) {
      fail(fmt::format("{}.vertices[{}]", field, i),
           "found a number that is not finite; expected metres");
    }
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t vertex : mesh.triangles[i]) {
      if (vertex < mesh.vertices.size()) continue;
      fail(fmt::format("{}.triangles[{}]", field, i),
           fmt::format("found the vertex {}; expected one of {}", vertex, mesh.vertices.size()));
    }
  }
  const bool is_hull = meshes_ == MeshForm::kHull;
  add_part(is_hull ? "polyhedron" : "mesh", is_hull ? hull_of(mesh) : file_of(mesh), pose);
}

YamlNode PartsWriter::hull_of(const Mesh& mesh) const {
  YamlNode vertices = empty(YamlNode::Kind::kSequence);
  for (const Vec3& vertex : with_volume(mesh.vertices, PartLimits{}.plate))
    vertices.items.push_back(lengths_node({vertex.data(), 3}, unit_));
  YamlNode shape = empty(YamlNode::Kind::kMap);
  set(shape, "vertices", std::move(vertices));
  return shape;
}

template <class Number>
void append_bytes(std::string& bytes, const Number& number) {
  static_assert(std::endian::native == std::endian::little);
  char raw[sizeof(Number)];
  std::memcpy(raw, &number, sizeof raw);
  bytes.append(raw, sizeof raw);
}

YamlNode PartsWriter::file_of(const Mesh& mesh) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double "
      "y\nproperty double z\nelement face {}\nproperty list uchar uint "
      "vertex_indices\nend_header\n",
      mesh.vertices.size(), mesh.triangles.size());
  for (const Vec3& vertex : mesh.vertices) {
    for (const double each : vertex) append_bytes(bytes, each);
  }
  for (const auto& triangle : mesh.triangles) {
    bytes.push_back(3);
    for (const std::uint32_t each : triangle) append_bytes(bytes, each);
  }
  Revision content;
  content.add(bytes);
  MeshFile file{fmt::format("moveit-{:016x}.ply", content.value()), std::move(bytes)};
  YamlNode shape = empty(YamlNode::Kind::kMap);
  set(shape, "file", text_node("sent:" + file.name));
  set(shape, "unit", text_node("m"));
  const auto same = [&](const MeshFile& each) { return each.name == file.name; };
  if (std::ranges::none_of(body_.files, same)) body_.files.push_back(std::move(file));
  return shape;
}

void PartsWriter::add_plane(const Plane& plane, const Pose& pose, const std::string& field) {
  const Vec3 normal(plane[0], plane[1], plane[2]);
  const double length = normal.norm();
  if (!std::isfinite(length) || !(length > 0.0) || !std::isfinite(plane[3])) {
    fail(field + ".coef", fmt::format("found [{}]; expected a, b, c, d with a normal a, b, c",
                                      fmt::join(plane, ", ")));
  }
  YamlNode direction = empty(YamlNode::Kind::kSequence);
  for (const double each : normal) direction.items.push_back(number_node(each));
  YamlNode shape = empty(YamlNode::Kind::kMap);
  set(shape, "normal", std::move(direction));
  set_length(shape, "offset", -plane[3]);
  body_.is_bounded = false;
  add_part("half_space", std::move(shape), pose);
}

}  // namespace

std::variant<Body, FieldFault> body_of(const CollisionObject& object, LengthUnit unit,
                                       MeshForm meshes) {
  try {
    return PartsWriter(object, unit, meshes).write();
  } catch (Fault& fault) {
    return std::move(fault.fault);
  }
}

std::variant<Pose, FieldFault> checked_pose(const Pose& pose, const std::string& field) {
  try {
    return usable_pose(pose, field);
  } catch (Fault& fault) {
    return std::move(fault.fault);
  }
}

YamlNode fixed_entry(const std::string& name, const std::string& group,
                     const Pose& world_from_object, YamlNode parts, LengthUnit unit) {
  YamlNode entry = named_entry(name, group);
  set(entry, "fixed", flag_node(true));
  set(entry, "pose", pose_node(world_from_object, unit));
  set(entry, "parts", std::move(parts));
  return entry;
}

YamlNode attached_entry(const std::string& name, const std::string& group,
                        const Attachment& attachment, YamlNode parts, LengthUnit unit) {
  YamlNode entry = named_entry(name, group);
  YamlNode attached = empty(YamlNode::Kind::kMap);
  set(attached, "to", text_node(attachment.to));
  set(attached, "pose", pose_node(attachment.carrier_from_object, unit));
  set(entry, "attached", std::move(attached));
  set_mass(mass_of(attachment.weight), entry);
  set(entry, "parts", std::move(parts));
  add_touch(attachment.touch, entry);
  return entry;
}

std::optional<double> mass_of(double weight) {
  return weight > 0.0 && std::isfinite(weight) ? std::optional(weight) : std::nullopt;
}

void set_mass(std::optional<double> mass, YamlNode& entry) {
  if (mass) set(entry, "mass", number_node(*mass));
}

void add_touch(const std::vector<std::string>& names, YamlNode& entry) {
  YamlNode* attached = find(entry, "attached");
  if (attached == nullptr || names.empty()) return;
  if (find(*attached, "touch") == nullptr)
    set(*attached, "touch", empty(YamlNode::Kind::kSequence));
  std::vector<YamlNode>& touch = find(*attached, "touch")->items;
  for (const std::string& name : names) {
    if (std::ranges::find(touch, name, &YamlNode::text) == touch.end())
      touch.push_back(text_node(name));
  }
}

}  // namespace clearance::moveit
