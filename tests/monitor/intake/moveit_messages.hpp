// Messages of MoveIt, and their bytes by the rules of CDR: field after field, as MoveIt's
// definitions have them. Fields that Clearance does not use have some content, which the fields
// behind them follow.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "config/moveit/message.hpp"
#include "tests/monitor/recording/ros_bags.hpp"

namespace clearance::moveit {

using test::RosCdr;

inline void put(RosCdr& cdr, double value) { cdr.number(value); }
inline void put(RosCdr& cdr, const std::string& text) { cdr.text(text); }
inline void put(RosCdr& cdr, const Vec3& point) {
  for (const double each : point) cdr.number(each);
}
inline void put(RosCdr& cdr, const Vec2& point) {
  for (const double each : {point.x(), point.y(), 9.0}) cdr.number(static_cast<float>(each));
}
inline void put(RosCdr& cdr, const Pose& pose) {
  put(cdr, pose.position);
  for (const double each : pose.orientation.coeffs()) cdr.number(each);  // x, y, z, w
}
inline void put(RosCdr& cdr, const std::array<std::uint32_t, 3>& triangle) {
  for (const std::uint32_t each : triangle) cdr.number(each);
}
inline void put(RosCdr& cdr, const Plane& plane) {
  for (const double each : plane) cdr.number(each);
}
inline void put(RosCdr& cdr, const std::vector<bool>& flags) {
  cdr.number(static_cast<std::uint32_t>(flags.size()));
  for (const bool each : flags) cdr.number(static_cast<std::uint8_t>(each));
}
template <class T>
void put(RosCdr& cdr, const std::vector<T>& list) {
  cdr.number(static_cast<std::uint32_t>(list.size()));
  for (const T& each : list) put(cdr, each);
}
inline void put(RosCdr& cdr, const SolidPrimitive& primitive) {
  cdr.number(primitive.type);
  put(cdr, primitive.dimensions);
  put(cdr, primitive.polygon);
}
inline void put(RosCdr& cdr, const Mesh& mesh) {
  put(cdr, mesh.triangles);
  put(cdr, mesh.vertices);
}
inline void put(RosCdr& cdr, const CollisionObject& object) {
  cdr.header(1'000'000'001, object.frame_id);
  put(cdr, object.pose);
  cdr.text(object.id).text("key").text("db");
  put(cdr, object.primitives);
  put(cdr, object.primitive_poses);
  put(cdr, object.meshes);
  put(cdr, object.mesh_poses);
  put(cdr, object.planes);
  put(cdr, object.plane_poses);
  put(cdr, object.subframe_names);
  put(cdr, object.subframe_poses);
  cdr.number(object.operation);
}
inline void put(RosCdr& cdr, const AttachedCollisionObject& attached) {
  cdr.text(attached.link_name);
  put(cdr, attached.object);
  put(cdr, attached.touch_links);
  // detach_posture: no names, one point with one position
  cdr.header(0, "").number(std::uint32_t{0}).number(std::uint32_t{1});
  cdr.numbers({0.04}).numbers({}).numbers({}).numbers({}).number(std::int32_t{1});
  cdr.number(std::uint32_t{0}).number(attached.weight);
}
inline void put(RosCdr& cdr, const FixedFrame& frame) {
  cdr.header(0, frame.frame_id).text(frame.child_frame_id);
  put(cdr, frame.child_from_frame);
}
inline void put(RosCdr& cdr, const LinkNumber& number) {
  cdr.text(number.link_name).number(number.value);
}
// The bytes of a binary octomap with cubes of 0.1 m, or nothing that can be decoded.
inline void put(RosCdr& cdr, const PlanningScene& scene, const std::string& octomap = {}) {
  constexpr std::uint32_t kNone = 0, kOne = 1;
  cdr.text(scene.name);
  cdr.header(0, "map").number(kOne).text("swing").numbers({0.5}).numbers({}).numbers({});
  cdr.header(0, "map").number(kNone).number(kNone).number(kNone).number(kNone);  // multi-DOF joints
  put(cdr, scene.attached);
  cdr.number(static_cast<std::uint8_t>(scene.robot_state_is_diff)).text("arm");
  put(cdr, scene.fixed_frame_transforms);
  const AllowedCollisionMatrix& matrix = scene.allowed_collision_matrix;
  put(cdr, matrix.entry_names);
  put(cdr, matrix.entry_values);
  put(cdr, matrix.default_entry_names);
  put(cdr, matrix.default_entry_values);
  put(cdr, scene.link_padding);
  put(cdr, scene.link_scale);
  cdr.number(kOne).text("held").number(1.F).number(0.F).number(0.F).number(1.F);  // colours
  put(cdr, scene.collision_objects);
  cdr.header(0, "map");
  put(cdr, Pose{});
  cdr.header(0, "map").number(std::uint8_t{1}).text("OcTree").number(0.1);
  const std::string bytes =
      octomap.empty() && scene.has_octomap ? std::string("\1\0\xFF", 3) : octomap;
  cdr.number(static_cast<std::uint32_t>(bytes.size()));
  for (const char byte : bytes) cdr.number(byte);
  cdr.number(static_cast<std::uint8_t>(scene.is_diff));
}

template <class Message>
[[nodiscard]] std::vector<std::byte> cdr_of(const Message& message) {
  RosCdr cdr;
  put(cdr, message);
  return cdr.bytes();
}

// A sphere of 0.1 m with its centre at `position`, in metres, in this frame.
[[nodiscard]] inline CollisionObject sphere_object(const std::string& id, const std::string& frame,
                                                   const Vec3& position) {
  CollisionObject object;
  object.frame_id = frame;
  object.id = id;
  object.pose.position = position;
  object.primitives = {{SolidPrimitive::kSphere, {0.1}}};
  return object;
}

// An object with a box, as most programs send it.
inline CollisionObject box_object(const std::string& id, const Pose& pose) {
  CollisionObject object;
  object.frame_id = "map";
  object.id = id;
  object.pose = pose;
  object.primitives = {{SolidPrimitive::kBox, {0.1, 0.2, 0.3}}};
  object.primitive_poses = {Pose{}};
  return object;
}

inline CollisionObject operation(Operation operation, const std::string& id) {
  CollisionObject object;
  object.frame_id = "map";
  object.id = id;
  object.operation = static_cast<std::uint8_t>(operation);
  return object;
}

}  // namespace clearance::moveit
