#include "monitor/publish/monitored_scene.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "monitor/visual/body_mesh.hpp"

namespace clearance {
namespace {

using moveit::AttachedCollisionObject;
using moveit::CollisionObject;

bool is_sphere(const ConvexBody& body) {
  return !body.is_curved() && body.facets.empty() && body.anchors.size() == 1 && body.radius > 0.0;
}

CollisionObject object_in(const std::string& frame, const Pose& pose, const Object& from) {
  CollisionObject object;
  object.frame_id = frame;
  object.id = from.name;
  object.pose = pose;
  for (const Part& part : from.parts) {
    const ConvexBody& body = part.shape;
    if (is_sphere(body)) {
      object.primitives.push_back({moveit::SolidPrimitive::kSphere, {body.radius}});
      Pose centre = part.object_from_part;
      centre.position = transform(centre, body.anchors.front());
      object.primitive_poses.push_back(centre);
    } else if (body.is_half_space()) {
      const Facet& facet = body.facets.front();
      object.planes.push_back(
          {facet.normal.x(), facet.normal.y(), facet.normal.z(), -(facet.offset + body.radius)});
      object.plane_poses.push_back(part.object_from_part);
    } else {
      BodyMesh mesh = body_mesh(body);
      object.meshes.push_back({std::move(mesh.triangles), std::move(mesh.positions)});
      object.mesh_poses.push_back(part.object_from_part);
    }
  }
  return object;
}

// Collects the bodies, and the pairs between them.
class SceneWriter {
 public:
  explicit SceneWriter(const Cell& cell) : scene_(cell.scene), world_(cell.ros.world()) {
    for (const ObjectPair& pair : scene_.pairs) watched_.insert({pair.first, pair.second});
  }
  moveit::PlanningScene write();

 private:
  void write_links();
  void write_attached(const Robot& robot);
  void write_matrix();
  bool is_watched(std::uint32_t a, std::uint32_t b) const {
    return watched_.contains(std::minmax(a, b));
  }

  const Scene& scene_;
  std::string world_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> watched_;
  std::set<std::uint32_t> links_;
  std::vector<std::uint32_t> bodies_;  // in the message
  moveit::PlanningScene message_;
};

void SceneWriter::write_links() {
  for (const Robot& robot : scene_.robots) {
    if (robot.is_attached) continue;
    for (const RobotLink& link : robot.links) {
      if (link.object != RobotLink::kNoObject) links_.insert(link.object);
    }
  }
  bodies_.assign(links_.begin(), links_.end());
  for (const std::uint32_t link : links_)
    message_.link_padding.push_back({scene_.objects[link].name, scene_.objects[link].margin});
}

void SceneWriter::write_attached(const Robot& robot) {
  const std::uint32_t object = robot.links.front().object;
  if (robot.base.kind != RobotBase::Kind::kLink || scene_.objects[object].absent) return;
  const Robot& carrier = scene_.robots[robot.base.robot];
  if (carrier.is_attached) return;
  AttachedCollisionObject attached;
  attached.link_name = carrier.links[robot.base.link].name;
  attached.object =
      object_in(attached.link_name, robot.base.base_from_root, scene_.objects[object]);
  for (const std::uint32_t link : links_) {
    if (!is_watched(link, object)) attached.touch_links.push_back(scene_.objects[link].name);
  }
  if (scene_.objects[object].mass < kInfinity) attached.weight = scene_.objects[object].mass;
  message_.attached.push_back(std::move(attached));
  bodies_.push_back(object);
}

void SceneWriter::write_matrix() {
  if (bodies_.size() > kMostInMatrix) return;
  moveit::AllowedCollisionMatrix& matrix = message_.allowed_collision_matrix;
  for (const std::uint32_t a : bodies_) {
    matrix.entry_names.push_back(scene_.objects[a].name);
    std::vector<bool>& row = matrix.entry_values.emplace_back();
    for (const std::uint32_t b : bodies_) row.push_back(!is_watched(a, b));
  }
}

moveit::PlanningScene SceneWriter::write() {
  message_.name = scene_.name;
  write_links();
  for (const Robot& robot : scene_.robots) {
    if (robot.is_attached) write_attached(robot);
  }
  for (std::uint32_t i = 0; i < scene_.objects.size(); ++i) {
    const Object& object = scene_.objects[i];
    if (!object.fixed || object.absent || links_.contains(i)) continue;
    message_.collision_objects.push_back(object_in(world_, object.world_from_object, object));
    bodies_.push_back(i);
  }
  write_matrix();
  return std::move(message_);
}

// ---- On the wire

void put(const std::string& from, char*& to) { to = dds_string_dup(from.c_str()); }

void put(const Vec3& from, geometry_msgs_msg_dds__Point_& to) {
  to = {from.x(), from.y(), from.z()};
}

void put(const Pose& from, geometry_msgs_msg_dds__Pose_& to) {
  put(from.position, to.position);
  const Eigen::Quaterniond& turn = from.orientation;
  to.orientation = {turn.x(), turn.y(), turn.z(), turn.w()};
}

void put(double from, double& to) { to = from; }

void put(const moveit::SolidPrimitive& from, shape_msgs_msg_dds__SolidPrimitive_& to);
void put(const moveit::Mesh& from, shape_msgs_msg_dds__Mesh_& to);
void put(const moveit::Plane& from, shape_msgs_msg_dds__Plane_& to) {
  std::ranges::copy(from, to.coef);
}
void put(const moveit::LinkNumber& from, moveit_msgs_msg_dds__LinkPadding_& to) {
  put(from.link_name, to.link_name);
  to.padding = from.value;
}
void put(const std::array<std::uint32_t, 3>& from, shape_msgs_msg_dds__MeshTriangle_& to) {
  std::ranges::copy(from, to.vertex_indices);
}
void put(const CollisionObject& from, moveit_msgs_msg_dds__CollisionObject_& to);
void put(const AttachedCollisionObject& from, moveit_msgs_msg_dds__AttachedCollisionObject_& to);

template <class From, class Sequence>
void put_all(const std::vector<From>& from, Sequence& to) {
  reserve_sequence(to, from.size());
  for (const From& each : from) put(each, to._buffer[to._length++]);
}

void put_flags(const std::vector<bool>& from, dds_sequence_bool& to) {
  reserve_sequence(to, from.size());
  for (const bool each : from) to._buffer[to._length++] = each;
}

void put(const moveit::SolidPrimitive& from, shape_msgs_msg_dds__SolidPrimitive_& to) {
  to.type = from.type;
  put_all(from.dimensions, to.dimensions);
}

void put(const moveit::Mesh& from, shape_msgs_msg_dds__Mesh_& to) {
  put_all(from.triangles, to.triangles);
  put_all(from.vertices, to.vertices);
}

void put(const CollisionObject& from, moveit_msgs_msg_dds__CollisionObject_& to) {
  put(from.frame_id, to.header.frame_id);
  put(from.pose, to.pose);
  put(from.id, to.id);
  put(std::string(), to.type.key);
  put(std::string(), to.type.db);
  put_all(from.primitives, to.primitives);
  put_all(from.primitive_poses, to.primitive_poses);
  put_all(from.meshes, to.meshes);
  put_all(from.mesh_poses, to.mesh_poses);
  put_all(from.planes, to.planes);
  put_all(from.plane_poses, to.plane_poses);
  to.operation = from.operation;
}

void put(const AttachedCollisionObject& from, moveit_msgs_msg_dds__AttachedCollisionObject_& to) {
  put(from.link_name, to.link_name);
  put(from.object, to.object);
  put_all(from.touch_links, to.touch_links);
  put(std::string(), to.detach_posture.header.frame_id);
  to.weight = from.weight;
}

}  // namespace

moveit::PlanningScene monitored_scene(const Cell& cell) { return SceneWriter(cell).write(); }

Sample<moveit_msgs_msg_dds__PlanningScene_> to_wire(const moveit::PlanningScene& scene) {
  Sample<moveit_msgs_msg_dds__PlanningScene_> message;
  put(scene.name, message->name);
  put(std::string(), message->robot_model_name);
  put(std::string(), message->robot_state.joint_state.header.frame_id);
  put(std::string(), message->robot_state.multi_dof_joint_state.header.frame_id);
  put_all(scene.attached, message->robot_state.attached_collision_objects);
  auto& matrix = message->allowed_collision_matrix;
  put_all(scene.allowed_collision_matrix.entry_names, matrix.entry_names);
  const auto& rows = scene.allowed_collision_matrix.entry_values;
  reserve_sequence(matrix.entry_values, rows.size());
  for (const std::vector<bool>& row : rows)
    put_flags(row, matrix.entry_values._buffer[matrix.entry_values._length++].enabled);
  put_all(scene.link_padding, message->link_padding);
  put_all(scene.collision_objects, message->world.collision_objects);
  auto& octomap = message->world.octomap;
  put(std::string(), octomap.header.frame_id);
  put(Pose{}, octomap.origin);
  put(std::string(), octomap.octomap.header.frame_id);
  put(std::string(), octomap.octomap.id);
  message->is_diff = scene.is_diff;
  return message;
}

}  // namespace clearance
