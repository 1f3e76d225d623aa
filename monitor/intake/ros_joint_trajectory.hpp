// trajectory_msgs/JointTrajectory of ROS 2 as a motion that can be asked about.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "config/scene/scene.hpp"
#include "monitor/interface/present_inputs.hpp"
#include "monitor/interface/question.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

// Decodes a message of this topic, "/arm/joint_trajectory", that comes at the tick of `state`.
// Returns the motion, whose time 0 is that of the tick, or a sentence that says why the message is
// none. A stamp of 0, and one before the tick, means that the motion begins at once. A stamp that
// is ahead by more than the age limit of its joints is refused, and a nearer one delays it.
//
// If a robot of the scene names its joint states in a namespace of the topic, the names of joints
// are that robot's, with or without its prefix, as those of its joint states are.
//
// A controller moves from where the joints are to the first point, if that has a time above 0.
// Their usable positions in `state` then become a waypoint at time 0, at rest. Refused is a joint
// that moves, and a continuous one that is half a turn or more from the first point.
//
// Velocities are taken if all points have them, and are refused if only some do. Messages with
// accelerations are refused, because the motion is then of a higher degree than cubic.
[[nodiscard]] std::variant<JointTrajectory, std::string> motion_of(std::string_view topic,
                                                                   std::span<const std::byte> cdr,
                                                                   CdrBytes bytes,
                                                                   const Scene& scene,
                                                                   const InputState& state);

}  // namespace clearance
