// An arm of boxes and a ball among boxes, balls and wedges, for MoveIt's environments and the
// oracle.
#pragma once

#include "exact_bodies.hpp"

#include <clearance_moveit/collision_env.hpp>
#include <cstddef>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <geometric_shapes/shapes.h>
#include <srdfdom/model.h>
#include <urdf_parser/urdf_parser.h>
#include <moveit/collision_detection_fcl/collision_env_fcl.hpp>
#include <moveit/robot_model/robot_model.hpp>
#include <moveit/robot_state/robot_state.hpp>

inline moveit::core::RobotModelPtr robot_model(const std::string& urdf_text,
                                               const std::string& srdf_text) {
  const auto urdf = urdf::parseURDF(urdf_text);
  const auto srdf = std::make_shared<srdf::Model>();
  srdf->initString(*urdf, srdf_text);
  return std::make_shared<moveit::core::RobotModel>(urdf, srdf);
}

// The joint "slide" moves the ball along x. All joints are at zero: the arm stands along z.
inline moveit::core::RobotModelPtr arm_model() {
  static const char* const kUrdf = R"(<robot name="arm">
  <link name="base"><collision><geometry><box size="0.3 0.3 0.2"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0 0 0.3"/><geometry><box size="0.1 0.12 0.5"/></geometry></collision></link>
  <link name="upper">
    <collision><origin xyz="0 0 0.2"/><geometry><box size="0.08 0.1 0.4"/></geometry></collision>
    <collision><origin xyz="0.1 0 0.1" rpy="0.3 0.2 0.1"/><geometry><box size="0.1 0.05 0.07"/></geometry></collision>
  </link>
  <link name="tip"><collision><geometry><sphere radius="0.06"/></geometry></collision></link>
  <joint name="turn" type="continuous"><parent link="base"/><child link="lower"/><origin xyz="0 0 0.12"/><axis xyz="0 0 1"/></joint>
  <joint name="bend" type="revolute"><parent link="lower"/><child link="upper"/><origin xyz="0 0 0.6"/><axis xyz="0 1 0"/>
    <limit lower="-2.5" upper="2.5" velocity="1" effort="1"/></joint>
  <joint name="slide" type="prismatic"><parent link="upper"/><child link="tip"/><origin xyz="0 0 0.5"/><axis xyz="1 0 0"/>
    <limit lower="-0.3" upper="0.3" velocity="1" effort="1"/></joint>
  </robot>)";
  static const char* const kSrdf =
      R"(<robot name="arm"><group name="all"><joint name="turn"/><joint name="bend"/><joint name="slide"/></group>
  <group name="wrist"><joint name="slide"/></group></robot>)";
  return robot_model(kUrdf, kSrdf);
}

// A shape with the same body for the oracle.
struct Thing {
  shapes::ShapeConstPtr shape;
  exact::Body body;
};

inline Thing box_thing(const Eigen::Vector3d& size) {
  return {std::make_shared<shapes::Box>(size.x(), size.y(), size.z()), exact::box(size)};
}
inline Thing ball_thing(double radius) {
  return {std::make_shared<shapes::Sphere>(radius), exact::ball(radius)};
}
// A mesh: the half of a box below a diagonal plane.
inline Thing wedge_thing(const Eigen::Vector3d& size) {
  exact::Body body;
  for (const double x : {-0.5, 0.5}) {
    body.vertices.emplace_back(x * size.x(), -0.5 * size.y(), -0.5 * size.z());
    body.vertices.emplace_back(x * size.x(), 0.5 * size.y(), -0.5 * size.z());
    body.vertices.emplace_back(x * size.x(), -0.5 * size.y(), 0.5 * size.z());
  }
  body.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                    {0, 3, 5}, {0, 5, 2}, {1, 2, 5}, {1, 5, 4}};
  auto mesh = std::make_shared<shapes::Mesh>(body.vertices.size(), body.triangles.size());
  for (std::size_t i = 0; i < body.vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k)
      mesh->vertices[3 * i + k] = static_cast<double>(body.vertices[i][k]);
  }
  for (std::size_t i = 0; i < body.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      mesh->triangles[3 * i + k] = static_cast<unsigned int>(body.triangles[i][k]);
  }
  mesh->computeTriangleNormals();
  mesh->computeVertexNormals();
  return {mesh, body};
}

struct ArmScene {
  moveit::core::RobotModelPtr model;
  collision_detection::WorldPtr world = std::make_shared<collision_detection::World>();
  moveit::core::RobotState state{model};
  clearance_moveit::CollisionEnv ours{model, world};
  collision_detection::CollisionEnvFCL fcl{model, world};
  std::map<std::string, exact::Body> things;  // in the world

  explicit ArmScene(const moveit::core::RobotModelPtr& of = arm_model()) : model(of) {
    state.setToDefaultValues();
    state.update();
  }
  void add(const std::string& name, const Thing& thing, const Eigen::Isometry3d& place) {
    world->addToObject(name, place, thing.shape, Eigen::Isometry3d::Identity());
    things[name] = exact::placed(thing.body, place);
  }
  void add(const std::string& name, const Thing& thing, const Eigen::Vector3d& at) {
    add(name, thing, Eigen::Isometry3d(Eigen::Translation3d(at)));
  }
  void set(double turn, double bend, double slide) {
    const std::vector<double> positions = {turn, bend, slide};
    state.setJointGroupPositions("all", positions);
    state.update();
  }
  // The bodies of a link at a state.
  [[nodiscard]] std::vector<exact::Body> link(const std::string& name,
                                              const moveit::core::RobotState& at) const {
    std::vector<exact::Body> bodies;
    const moveit::core::LinkModel* link = model->getLinkModel(name);
    for (std::size_t i = 0; i < link->getShapes().size(); ++i) {
      const shapes::Shape& shape = *link->getShapes()[i];
      const auto* box = dynamic_cast<const shapes::Box*>(&shape);
      const exact::Body body = box != nullptr
                                   ? exact::box({box->size[0], box->size[1], box->size[2]})
                                   : exact::ball(dynamic_cast<const shapes::Sphere&>(shape).radius);
      bodies.push_back(exact::placed(
          body, at.getGlobalLinkTransform(link) * link->getCollisionOriginTransforms()[i]));
    }
    return bodies;
  }
  [[nodiscard]] double exact_distance(const std::string& name, const exact::Body& other,
                                      const moveit::core::RobotState& at) const {
    double least = std::numeric_limits<double>::infinity();
    for (const exact::Body& body : link(name, at))
      least = std::min(least, exact::distance(body, other));
    return least;
  }
  [[nodiscard]] double exact_distance(const std::string& name, const std::string& thing) const {
    return exact_distance(name, things.at(thing), state);
  }
  // Of all links to all things.
  [[nodiscard]] double exact_distance_at(const moveit::core::RobotState& at) const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::string& name : model->getLinkModelNames()) {
      for (const auto& [thing, body] : things)
        least = std::min(least, exact_distance(name, body, at));
    }
    return least;
  }
};

// Random scenes by a fixed seed.
class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) *
                     (static_cast<double>(engine_()) / static_cast<double>(std::mt19937::max()));
  }
  Eigen::Vector3d vector(double low, double high) {
    const double x = between(low, high), y = between(low, high);
    return {x, y, between(low, high)};
  }
  Eigen::Isometry3d place(double reach) {
    const Eigen::Vector3d axis = vector(-1.0, 1.0).normalized();
    const Eigen::Vector3d at = vector(-reach, reach) + Eigen::Vector3d(0.0, 0.0, 0.5);
    return Eigen::Translation3d(at) * Eigen::AngleAxisd(between(0.0, 3.0), axis);
  }
  void fill(ArmScene& scene, int things) {
    for (int i = 0; i < things; ++i) {
      const Thing thing = i % 3 == 0   ? box_thing(vector(0.02, 0.3))
                          : i % 3 == 1 ? wedge_thing(vector(0.05, 0.3))
                                       : ball_thing(between(0.01, 0.15));
      scene.add("thing" + std::to_string(i), thing, place(0.8));
    }
  }
  void pose(ArmScene& scene) {
    const double turn = between(-3.0, 3.0), bend = between(-2.4, 2.4);
    scene.set(turn, bend, between(-0.3, 0.3));
  }

 private:
  std::mt19937 engine_;
};
