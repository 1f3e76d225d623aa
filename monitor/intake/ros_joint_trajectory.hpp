// trajectory_msgs/JointTrajectory of ROS 2 as a motion that can be asked about.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "monitor/interface/question.hpp"
#include "monitor/wire/moveit_types.hpp"

namespace clearance {

// Returns the motion on the clock of time_from_start, or a sentence that says why the message is
// none. A controller moves from where the joints are to the first point, if that has a time above
// 0. `held` then gives their positions, which become a waypoint at time 0, at rest.
//
// Velocities are taken if all points have them. Messages with accelerations are refused, because
// the motion is then of a higher degree than cubic.
[[nodiscard]] std::variant<JointTrajectory, std::string> motion_of(
    const trajectory_msgs_msg_dds__JointTrajectory_& message, const std::vector<HeldJoint>& held);

}  // namespace clearance
