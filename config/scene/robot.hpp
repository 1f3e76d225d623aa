// A robot by its description: a tree of links that joints move. config/urdf/robot_model.hpp reads
// it from URDF; monitor/bodies places its links.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "config/scene/place_error.hpp"
#include "config/scene/ros_stamps.hpp"
#include "config/scene/stopping.hpp"
#include "core/pose.hpp"

namespace clearance {

// The types of joints in URDF.
enum class JointType : std::uint8_t {
  kFixed,
  kRevolute,    // rotates about its axis, within limits
  kContinuous,  // rotates about its axis
  kPrismatic,   // slides along its axis, within limits
  kPlanar,      // slides in the plane across its axis, and rotates about it
  kFloating,    // six degrees of freedom
};

// Returns how many numbers give the position of a joint of this type. A planar joint has x, y and
// an angle; a floating one x, y, z and a quaternion x, y, z, w.
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

// One number of a joint state: rad, m, or an entry of a quaternion.
struct JointVariable {
  // The joint's name with the robot's prefix. Joints of several variables have MoveIt's names for
  // them: NAME/x, NAME/theta, NAME/trans_x, NAME/rot_w ...
  std::string name;
  // The limits of its position, rad or m, and of its speed, rad/s or m/s; infinite: not stated.
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double max_speed = std::numeric_limits<double>::infinity();
  // The limits of URDF 1.2, rad/s2 or m/s2; infinite: not stated. They count where the cell says
  // so.
  double urdf_acceleration = std::numeric_limits<double>::infinity();
  double urdf_deceleration = std::numeric_limits<double>::infinity();
  // The speed above which positions are not plausible, if `max_speed` is not stated. It does not
  // bound the unobserved motion of late inputs.
  double unstated_speed = std::numeric_limits<double>::infinity();
  // A sent velocity may exceed plausible_speed() by this factor: the limits of many descriptions
  // are too low. A speed that the cell states has no such tolerance.
  double speed_tolerance = 4.0;
  // A position that is farther outside its limits than this is not plausible; rad or m.
  double limit_tolerance = 0.0;
  // Velocities are differences of positions that one message tells alone, so that no position
  // contradicts them: of the base of a robot that follows a frame of tf.
  bool velocity_is_difference = false;
  bool wraps = false;  // an angle that is the same after a full turn
  // Stated: the joint stands here, and its joint states do not count. NaN: it is read.
  double held = std::numeric_limits<double>::quiet_NaN();
  std::int64_t age_limit_ns = 0;     // an older position is late
  std::int64_t frozen_limit_ns = 0;  // the joint may keep its position for this long; 0: always
  // Index into Scene::variables of the first variable of its joint.
  std::uint32_t first_of_joint = 0;
  std::string source;       // the only source that is used; empty: the first that sends some
  std::uint32_t robot = 0;  // index into Scene::robots
  bool is_read = true;      // as Object::is_read; false of an absent robot, too

  [[nodiscard]] bool is_held() const noexcept { return !std::isnan(held); }
  // A position that needs a higher speed than this, per second, contradicts the one before.
  [[nodiscard]] double plausible_speed() const noexcept {
    return std::isfinite(max_speed) ? max_speed : unstated_speed;
  }
};

// Joint i carries link i + 1, and `parent` is before that: a loop over joints meets parents first.
struct RobotJoint {
  std::string name;  // with the robot's prefix
  JointType type = JointType::kFixed;
  std::uint32_t parent = 0;  // index into Robot::links
  Pose parent_from_joint;    // at position 0; its orientation is rounded once from rpy
  // A unit vector in the joint's frame. A planar joint has the normal of its plane, in which
  // plane_x and plane_y lie.
  Vec3 axis = Vec3::UnitZ(), plane_x = Vec3::UnitX(), plane_y = Vec3::UnitY();
  // Index into Scene::variables of its first variable. A joint that mimics another has the variable
  // of that one: position = multiplier * variable + offset.
  std::uint32_t variable = 0;
  double multiplier = 1.0, offset = 0.0;
  JointError error = {};  // stated

  // False if the position is the variable itself, without any rounding.
  [[nodiscard]] bool rescales() const noexcept {
    return std::abs(multiplier) != 1.0 || offset != 0.0;
  }
};

struct RobotLink {
  static constexpr std::uint32_t kNoObject = std::numeric_limits<std::uint32_t>::max();
  std::string name;                  // with the robot's prefix
  std::uint32_t object = kNoObject;  // index into Scene::objects; or a frame only
};

// The place of the root link: the world, an object, or a link of another robot.
struct RobotBase {
  enum class Kind : std::uint8_t { kWorld, kObject, kLink };
  Kind kind = Kind::kWorld;
  std::uint32_t object = 0;           // index into Scene::objects: a moving one
  std::uint32_t robot = 0, link = 0;  // an earlier robot
  Pose base_from_root;                // in the frame of the world, object or link
  RestingOn resting_on = {};          // with kWorld
  // The frame of tf that the base follows, and the root link's pose in it. The robot then gets an
  // additional first joint, a floating one, that no description contains. Empty if the base follows
  // no frame.
  std::string frame;
  Pose frame_from_root;

  friend bool operator==(const RobotBase& a, const RobotBase& b) {
    return a.kind == b.kind && a.object == b.object && a.robot == b.robot && a.link == b.link &&
           same_pose(a.base_from_root, b.base_from_root) && a.resting_on == b.resting_on &&
           a.frame == b.frame && same_pose(a.frame_from_root, b.frame_from_root);
  }
};

// A person by the skeleton of ROS4HRI. The objects of its links say whether it is there.
struct Person {
  // The body's name in /humans/bodies, which the names of its joints and of its frame end with.
  // Empty: the person is there, and nothing says as which body.
  std::string id;
};

struct Robot {
  std::string name;
  std::string prefix;  // its names begin with it in this cell
  // The only topic of ROS 2 whose joints are this robot's, with or without the prefix:
  // "/left/joint_states". Empty: any topic, by the names with the prefix.
  std::string joint_states;
  RosStamps stamps = RosStamps::kMessage;
  RobotBase base;
  PlaceError base_error = {};  // stated; of the root link in what it stands on
  // One link without a joint: an object of the cell that moves with the base. It has the object's
  // name, and is no robot to a person.
  bool is_attached = false;
  std::vector<RobotLink> links;  // the root first
  std::vector<RobotJoint> joints;
  // Of a tool, kg; infinity: not stated. Of what is attached, Object::mass counts.
  double mass = std::numeric_limits<double>::infinity();
  RobotStops stopping = {};  // stated
  std::optional<Person> person = {};
  std::vector<std::string> notes;  // for the log: what was left out, and why

  // Tells whether the variable belongs to the base, which follows a frame of tf.
  [[nodiscard]] bool is_of_base(std::uint32_t variable) const noexcept {
    return !base.frame.empty() && variable >= joints.front().variable &&
           variable < joints.front().variable + variables_of(JointType::kFloating);
  }
};

}  // namespace clearance
