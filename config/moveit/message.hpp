// MoveIt's messages that keep a scene, as plain structs: what idl/moveit.idl has on the wire, and a
// YAML file has as text. Fields that Clearance does not use are left out.
//
// Values are as they were sent, and unchecked. Lengths are in metres. Names of fields are MoveIt's.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/pose.hpp"

namespace clearance::moveit {

// shape_msgs/SolidPrimitive. Bodies are centred at their origin, along z.
struct SolidPrimitive {
  static constexpr std::uint8_t kBox = 1, kSphere = 2, kCylinder = 3, kCone = 4, kPrism = 5;
  std::uint8_t type = 0;
  // box: x y z; sphere: radius; cylinder, cone: height radius; prism: height
  std::vector<double> dimensions = {};
  std::vector<Vec2> polygon = {};  // the base of a prism
};

// shape_msgs/Mesh.
struct Mesh {
  std::vector<std::array<std::uint32_t, 3>> triangles = {};  // indices of vertices
  std::vector<Vec3> vertices = {};
};

// shape_msgs/Plane: a x + b y + c z + d = 0.
using Plane = std::array<double, 4>;

enum class Operation : std::uint8_t { kAdd = 0, kRemove = 1, kAppend = 2, kMove = 3 };

struct CollisionObject {
  std::string frame_id = {};  // header.frame_id: of all poses of this message
  Pose pose = {};             // of the object
  std::string id = {};
  // Poses are in the object's frame; a shape without one is at its origin.
  std::vector<SolidPrimitive> primitives = {};
  std::vector<Pose> primitive_poses = {};
  std::vector<Mesh> meshes = {};
  std::vector<Pose> mesh_poses = {};
  std::vector<Plane> planes = {};
  std::vector<Pose> plane_poses = {};
  std::vector<std::string> subframe_names = {};
  std::vector<Pose> subframe_poses = {};
  std::uint8_t operation = 0;  // Operation

  [[nodiscard]] std::size_t shapes() const noexcept {
    return primitives.size() + meshes.size() + planes.size();
  }
};

struct AttachedCollisionObject {
  std::string link_name = {};
  CollisionObject object = {};
  std::vector<std::string> touch_links = {};
  double weight = 0.0;  // kg; 0: not known
};

// A square matrix: entry_values[i][j] tells whether i and j may touch. For pairs outside of it the
// default entries of both names count.
struct AllowedCollisionMatrix {
  std::vector<std::string> entry_names = {};
  std::vector<std::vector<bool>> entry_values = {};
  std::vector<std::string> default_entry_names = {};
  std::vector<bool> default_entry_values = {};
};

// An entry of fixed_frame_transforms. MoveIt reads it as the pose of header.frame_id in the frame
// child_frame_id, unlike tf.
struct FixedFrame {
  std::string frame_id = {}, child_frame_id = {};
  Pose child_from_frame = {};
};

struct LinkNumber {
  std::string link_name = {};
  double value = 0.0;
};

struct PlanningScene {
  std::string name = {};
  std::vector<AttachedCollisionObject> attached = {};  // of robot_state
  bool robot_state_is_diff = false;
  std::vector<FixedFrame> fixed_frame_transforms = {};
  AllowedCollisionMatrix allowed_collision_matrix = {};
  std::vector<LinkNumber> link_padding = {};  // m
  std::vector<LinkNumber> link_scale = {};
  std::vector<CollisionObject> collision_objects = {};  // of world
  bool has_octomap = false;
  bool is_diff = false;
};

// A value of a message that cannot be used.
struct FieldFault {
  std::string field;   // as in the message: "world.collision_objects[0].primitives[2].dimensions"
  std::string reason;  // "found ...; expected ..."
};

}  // namespace clearance::moveit
