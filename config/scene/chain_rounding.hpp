// How far a robot's links can be from where the doubles of forward kinematics put them.
#pragma once

#include <vector>

#include "config/scene/robot.hpp"
#include "config/scene/scene.hpp"

namespace clearance {

// How far a joint's rotation can be from the exact one, rad, and its step for each metre: the
// origin's quaternion, made of three angles by some forty operations, is within 2^-48 of its half,
// the half angle's sine and cosine within 2^-50, and two products of quaternions round eight times
// more.
inline constexpr double kJointError = 0x1p-46;
// Of a position that is scaled and shifted (mimic), for each radian or metre.
inline constexpr double kPositionError = 0x1p-51;

// Up to these the bound below holds: angles, rad; ways of joints without limits, and how far an
// object that a robot stands on is from the world's origin, m.
inline constexpr double kSureAngle = 1e3;
inline constexpr double kSureWay = 1e2;

// No point within r of a link's origin is farther than shift + turn r from where the chain has it.
struct ChainError {
  double shift = 0.0;  // m
  double turn = 0.0;   // rad
};

// Of every link of the last of these robots, as Robot::links. The robots before it are those that
// it may stand on.
[[nodiscard]] std::vector<ChainError> chain_rounding(const std::vector<Robot>& robots,
                                                     const std::vector<JointVariable>& variables);

// The object's points are where its pose puts them, to within this error of the pose: its parts'
// own errors grow by it, so that every bound holds for the chain. Object::pose_error is set.
void account_for(const ChainError& error, Object& object);

}  // namespace clearance
