// How all that hangs on a joint moves in the world as one of the joint's positions grows.
#pragma once

#include <span>

#include "config/scene/robot.hpp"
#include "monitor/kinematics/forward_kinematics.hpp"
#include "monitor/kinematics/tracked_variable.hpp"

namespace clearance {

// A point p moves by linear + angular x (p - origin), m, for each rad or m of the position; NaN
// where that is not known.
struct JointScrew {
  Vec3 angular = Vec3::Zero(), linear = Vec3::Zero();
  Vec3 origin = Vec3::Zero();
};

// Of each position of a joint: variables_of(joint.type) screws. For one that mimics another they
// are by the other's position. `parent`, `child`: the links before and behind it, as placed with
// these variables (as Scene::variables).
void screws_of(const RobotJoint& joint, const LinkState& parent, const LinkState& child,
               std::span<const TrackedVariable> variables, std::span<JointScrew> screws) noexcept;

}  // namespace clearance
