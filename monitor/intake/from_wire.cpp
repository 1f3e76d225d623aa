#include "monitor/intake/from_wire.hpp"

#include <algorithm>
#include <span>
#include <type_traits>

namespace clearance::moveit {
namespace {

std::string text(const char* from) { return from == nullptr ? "" : from; }

template <class Sequence, class Convert>
auto list(const Sequence& from, const Convert& convert) {
  std::vector<std::decay_t<decltype(convert(from._buffer[0]))>> to;
  to.reserve(from._length);
  for (std::uint32_t i = 0; i < from._length; ++i) to.push_back(convert(from._buffer[i]));
  return to;
}

Vec3 vector(const geometry_msgs_msg_dds__Point_& from) { return {from.x, from.y, from.z}; }

Pose pose(const geometry_msgs_msg_dds__Pose_& from) {
  const auto& turn = from.orientation;
  return {vector(from.position), {turn.w, turn.x, turn.y, turn.z}};
}

SolidPrimitive primitive(const shape_msgs_msg_dds__SolidPrimitive_& from) {
  SolidPrimitive to;
  to.type = from.type;
  to.dimensions = list(from.dimensions, [](double each) { return each; });
  to.polygon = list(from.polygon.points, [](const geometry_msgs_msg_dds__Point32_& each) {
    return Vec2(static_cast<double>(each.x), static_cast<double>(each.y));
  });
  return to;
}

Mesh mesh(const shape_msgs_msg_dds__Mesh_& from) {
  Mesh to;
  to.triangles = list(from.triangles, [](const shape_msgs_msg_dds__MeshTriangle_& each) {
    return std::to_array(each.vertex_indices);
  });
  to.vertices = list(from.vertices, vector);
  return to;
}

FixedFrame frame(const geometry_msgs_msg_dds__TransformStamped_& from) {
  const auto& [translation, turn] = from.transform;
  return {text(from.header.frame_id),
          text(from.child_frame_id),
          {{translation.x, translation.y, translation.z}, {turn.w, turn.x, turn.y, turn.z}}};
}

template <class Sequence>
std::vector<std::string> names(const Sequence& from) {
  return list(from, text);
}

}  // namespace

CollisionObject from_wire(const moveit_msgs_msg_dds__CollisionObject_& message) {
  CollisionObject object;
  object.frame_id = text(message.header.frame_id);
  object.pose = pose(message.pose);
  object.id = text(message.id);
  object.primitives = list(message.primitives, primitive);
  object.primitive_poses = list(message.primitive_poses, pose);
  object.meshes = list(message.meshes, mesh);
  object.mesh_poses = list(message.mesh_poses, pose);
  object.planes = list(message.planes, [](const shape_msgs_msg_dds__Plane_& each) {
    return std::to_array(each.coef);
  });
  object.plane_poses = list(message.plane_poses, pose);
  object.subframe_names = names(message.subframe_names);
  object.subframe_poses = list(message.subframe_poses, pose);
  object.operation = message.operation;
  return object;
}

AttachedCollisionObject from_wire(const moveit_msgs_msg_dds__AttachedCollisionObject_& message) {
  return {text(message.link_name), from_wire(message.object), names(message.touch_links),
          message.weight};
}

PlanningScene from_wire(const moveit_msgs_msg_dds__PlanningScene_& message) {
  PlanningScene scene;
  scene.name = text(message.name);
  const auto object = [](const auto& each) { return from_wire(each); };
  scene.attached = list(message.robot_state.attached_collision_objects, object);
  scene.robot_state_is_diff = message.robot_state.is_diff;
  scene.fixed_frame_transforms = list(message.fixed_frame_transforms, frame);
  const auto& matrix = message.allowed_collision_matrix;
  const auto flag = [](bool each) { return each; };
  scene.allowed_collision_matrix.entry_names = names(matrix.entry_names);
  scene.allowed_collision_matrix.entry_values =
      list(matrix.entry_values, [&](const moveit_msgs_msg_dds__AllowedCollisionEntry_& each) {
        return list(each.enabled, flag);
      });
  scene.allowed_collision_matrix.default_entry_names = names(matrix.default_entry_names);
  scene.allowed_collision_matrix.default_entry_values = list(matrix.default_entry_values, flag);
  scene.link_padding = list(message.link_padding, [](const auto& each) {
    return LinkNumber{text(each.link_name), each.padding};
  });
  scene.link_scale = list(message.link_scale, [](const auto& each) {
    return LinkNumber{text(each.link_name), each.scale};
  });
  scene.collision_objects = list(message.world.collision_objects, object);
  scene.has_octomap = message.world.octomap.octomap.data._length > 0;
  scene.is_diff = message.is_diff;
  return scene;
}

}  // namespace clearance::moveit
