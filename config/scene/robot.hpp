// A robot as its description says: a tree of links that joints move. Read from URDF by
// config/urdf/robot_model.hpp; monitor/kinematics places its links.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "config/scene/ros_stamps.hpp"
#include "core/pose.hpp"

namespace clearance {

// As in URDF.
enum class JointType : std::uint8_t {
  kFixed,
  kRevolute,    // turns about its axis, within limits
  kContinuous,  // turns about its axis
  kPrismatic,   // slides along its axis, within limits
  kPlanar,      // slides in the plane across its axis, and turns about it
  kFloating,    // six degrees of freedom
};

// How many numbers say where a joint of this type is: planar x, y, angle; floating x, y, z and a
// quaternion x, y, z, w.
[[nodiscard]] constexpr std::uint32_t variables_of(JointType type) noexcept {
  switch (type) {
    case JointType::kFixed:
      return 0;
    case JointType::kPlanar:
      return 3;
    case JointType::kFloating:
      return 7;
    case JointType::kRevolute:
    case JointType::kContinuous:
    case JointType::kPrismatic:
      return 1;
  }
  return 0;
}

// One number that a joint state gives; rad, m, or an entry of a quaternion.
struct JointVariable {
  // The joint's, with the robot's prefix; of several of one joint, as MoveIt calls them: NAME/x,
  // NAME/theta, NAME/trans_x, NAME/rot_w ...
  std::string name;
  // Where it stays, and how fast it moves at most, per second; infinite: nothing is stated.
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double max_speed = std::numeric_limits<double>::infinity();
  std::int64_t age_limit_ns = 0;  // an older position is late
  std::string source;             // only this source's are used; empty: the first that sends some
  std::uint32_t robot = 0;        // index into Scene::robots
};

// Joint i carries link i + 1, and `parent` is before that: a loop over joints meets parents first.
struct RobotJoint {
  std::string name;  // with the robot's prefix
  JointType type = JointType::kFixed;
  std::uint32_t parent = 0;  // index into Robot::links
  Pose parent_from_joint;    // at position 0; its orientation is rounded once from rpy
  // Unit, in the joint's frame; of a planar joint the normal of its plane, in which x and y lie.
  Vec3 axis = Vec3::UnitZ(), plane_x = Vec3::UnitX(), plane_y = Vec3::UnitY();
  // The first of its variables, index into Scene::variables. A joint that mimics another has that
  // one's: position = multiplier * variable + offset.
  std::uint32_t variable = 0;
  double multiplier = 1.0, offset = 0.0;
};

struct RobotLink {
  static constexpr std::uint32_t kNoObject = std::numeric_limits<std::uint32_t>::max();
  std::string name;                  // with the robot's prefix
  std::uint32_t object = kNoObject;  // index into Scene::objects, in the link's frame; or a frame
};

// What the root link stands on.
struct RobotBase {
  enum class Kind : std::uint8_t { kWorld, kObject, kLink };
  Kind kind = Kind::kWorld;
  std::uint32_t object = 0;           // index into Scene::objects, of a moving object
  std::uint32_t robot = 0, link = 0;  // of a robot before this one
  Pose base_from_root;                // where, in the frame of that
  // The frame of tf that it follows, and where the root link is in that. Its first joint is then
  // floating, one that the description does not have. Empty: none.
  std::string frame;
  Pose frame_from_root;
};

struct Robot {
  std::string name;
  std::string prefix;  // of its names in this cell
  // The topic of ROS 2 whose joints are this robot's, with or without the prefix, and no other
  // topic's are; "/left/joint_states". Empty: any topic, by the names with the prefix.
  std::string joint_states;
  RosStamps stamps = RosStamps::kMessage;
  RobotBase base;
  std::vector<RobotLink> links;  // the root first
  std::vector<RobotJoint> joints;
  std::vector<std::string> notes;  // what was left out, and why: for the log

  // Whether the variable says where its base is, as a frame of tf does.
  [[nodiscard]] bool is_of_base(std::uint32_t variable) const noexcept {
    return !base.frame.empty() && variable >= joints.front().variable &&
           variable < joints.front().variable + variables_of(JointType::kFloating);
  }
};

}  // namespace clearance
