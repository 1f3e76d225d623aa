// What counts as plausible of a joint's positions: it follows from the joint's type and limits, and
// where these state nothing, from defaults.
#pragma once

#include <vector>

#include "config/scene/robot.hpp"

namespace clearance {

// Above these speeds, positions are not plausible where the cell and the description state none.
// They bound no motion that is not seen. The base is one that follows a frame of tf.
inline constexpr double kFastestTurnUnstated = 100.0;  // rad/s
inline constexpr double kFastestSlideUnstated = 20.0;  // m/s
inline constexpr double kFastestBase = 5.0;            // m/s
inline constexpr double kFastestBaseTurn = 6.3;        // rad/s

// A position may be outside its limits by this share of their range, but at least by these:
// encoders have offsets, and controllers overshoot.
inline constexpr double kLimitShare = 0.01;
inline constexpr double kLeastAngleTolerance = 0.02;    // rad
inline constexpr double kLeastLengthTolerance = 0.002;  // m

// Sets unstated_speed, limit_tolerance, wraps and first_of_joint of the robot's variables. The
// limits must be final, and `variables` those of all robots.
void set_plausible_motion(const Robot& robot, std::vector<JointVariable>& variables);

}  // namespace clearance
