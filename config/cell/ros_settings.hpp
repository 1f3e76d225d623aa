// The settings of a cell for ROS 2, except those of joint states: the topics that are written,
// those of MoveIt that are read, and the frame that is its world.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "config/scene/ros_stamps.hpp"

namespace clearance {

// Topics by their names in ROS 2, "/diagnostics"; an empty one is not written.
struct RosOutputs {
  std::string markers, diagnostics, minimum_distance, speed_scaling, monitored_planning_scene, log;
  std::string messages;  // not a topic, but the namespace of those in kRosMessages
};

// One row an output: its key in a cell, and its topic where the cell names none.
struct RosOutput {
  std::string_view key;
  std::string RosOutputs::*topic;
  std::string_view standard_topic;
};
inline constexpr std::array<RosOutput, 7> kRosOutputs = {{
    {"markers", &RosOutputs::markers, "/clearance/markers"},
    {"diagnostics", &RosOutputs::diagnostics, "/diagnostics"},
    {"minimum_distance", &RosOutputs::minimum_distance, "/clearance/minimum_distance"},
    {"speed_scaling", &RosOutputs::speed_scaling, "/clearance/speed_scaling"},
    {"monitored_planning_scene", &RosOutputs::monitored_planning_scene,
     "/clearance/monitored_planning_scene"},
    {"log", &RosOutputs::log, "/rosout"},
    {"messages", &RosOutputs::messages, "/clearance"},
}};

// The topics below the namespace `messages`, by the keys of the daemon's own topics.
inline constexpr std::array<std::string_view, 6> kRosMessages = {
    "catalogue", "distances", "zones", "health", "separation", "gradients"};

// The messages that keep the scene: MoveIt's, and the ids of ROS4HRI's bodies, which stand for the
// persons of the cell. Topics by their names in ROS 2; an empty one is not read.
struct MoveItInputs {
  std::string collision_object, attached_collision_object, planning_scene, tracked_bodies;
  // The group of the objects that MoveIt adds. A rule for pairs has to name it.
  std::string group = "moveit";

  [[nodiscard]] bool adds_objects() const noexcept {
    return !collision_object.empty() || !attached_collision_object.empty() ||
           !planning_scene.empty();
  }
  [[nodiscard]] bool any() const noexcept { return adds_objects() || !tracked_bodies.empty(); }
};

// One row an input: its key in a cell, and its topic where the cell says `true`.
struct MoveItInput {
  std::string_view key;
  std::string MoveItInputs::*topic;
  std::string_view standard_topic;
};
inline constexpr std::array<MoveItInput, 4> kMoveItInputs = {{
    {"collision_object", &MoveItInputs::collision_object, "/collision_object"},
    {"attached_collision_object", &MoveItInputs::attached_collision_object,
     "/attached_collision_object"},
    {"planning_scene", &MoveItInputs::planning_scene, "/planning_scene"},
    {"tracked_bodies", &MoveItInputs::tracked_bodies, "/humans/bodies/tracked"},
}};

// Topics of trajectory_msgs/JointTrajectory, in ROS 2's spelling: each motion is asked about. The
// answers come on /diagnostics and TOPIC/clearance.
struct RosTrajectories {
  std::vector<std::string> topics;   // none: off
  std::vector<double> margins{0.0};  // m, from 0 on
  bool operator==(const RosTrajectories&) const = default;
};

struct RosSettings {
  RosOutputs outputs;
  MoveItInputs moveit;
  RosTrajectories trajectories;
  double markers_hz = 30.0;
  // The frame of tf that is the cell's world; required where an object or a base follows a frame.
  // Empty: outputs call it "world".
  std::string world_frame;
  RosStamps stamps = RosStamps::kMessage;  // of tf
  bool use_sim_time = false;               // the time is that of /clock

  [[nodiscard]] std::string world() const { return world_frame.empty() ? "world" : world_frame; }
};

// Tells whether `name` is a topic of ROS 2: "/", then names with "/" between them. A name has
// letters, digits and "_", and does not begin with a digit.
[[nodiscard]] bool is_ros_topic(std::string_view name) noexcept;

}  // namespace clearance
