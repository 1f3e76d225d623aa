// Decides which positions of a joint are plausible, from its type and its limits. Defaults replace
// limits that are not stated.
#pragma once

#include <vector>

#include "config/scene/robot.hpp"

namespace clearance {

// If neither the cell nor the description states a speed, positions that need more than these are
// not plausible. These speeds do not bound the unobserved motion of late inputs. `Base` is a robot
// base that follows a frame of tf.
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
// limits must be final, and `variables` those of all robots. The robot's notes name what is
// continuous and must not wrap.
void set_plausible_motion(Robot& robot, std::vector<JointVariable>& variables);

}  // namespace clearance
