// Bounds the error of the poses of a robot's links that forward kinematics computes in doubles.
#pragma once

#include <vector>

#include "config/scene/robot.hpp"
#include "config/scene/scene.hpp"

namespace clearance {

// A joint's rotation is within this of the exact one, rad. Its translation is within this share of
// its length. The origin's quaternion is made of three angles by some forty operations, and half of
// its angle is within 2^-48. The half angle's sine and cosine are within 2^-50, and two products of
// quaternions round eight times more.
inline constexpr double kJointError = 0x1p-46;
// A position that is scaled and shifted (mimic) is within this, for each radian or metre.
inline constexpr double kPositionError = 0x1p-51;

// The bounds hold up to this length, m. It limits the positions of joints that state no limits, and
// the distance of an object that carries a robot.
inline constexpr double kLargestLength = 1e4;
// Every joint is charged with the rounding of at least this angle, rad, scaled as a joint that
// mimics another scales it. A joint with a larger range is charged with that, up to 1e6 rad.
inline constexpr double kLeastSureAngle = 1e3;

// No point within r of a link's origin is farther than shift + turn r from its place by forward
// kinematics.
struct ChainError {
  double shift = 0.0;  // m
  double turn = 0.0;   // rad
};

// Returns the largest length by which the joint moves its link, as ForwardKinematics computes it,
// m.
[[nodiscard]] double largest_slide(const RobotJoint& joint,
                                   const std::vector<JointVariable>& variables);

// Returns the error of every link of the last robot, in the order of Robot::links. The robots
// before it are needed because it may stand on them.
[[nodiscard]] std::vector<ChainError> chain_rounding(const std::vector<Robot>& robots,
                                                     const std::vector<JointVariable>& variables);

// Widens the errors of the object's parts by this error of its pose, so that every bound holds for
// the chain. Object::pose_error is set.
void account_for(const ChainError& error, Object& object);

}  // namespace clearance
