// Joint screws: the velocity of everything that a joint carries, per unit of one of its positions.
#pragma once

#include <span>

#include "config/scene/robot.hpp"
#include "monitor/bodies/forward_kinematics.hpp"
#include "monitor/bodies/tracked_variable.hpp"

namespace clearance {

// A point p moves by linear + angular x (p - origin), m, for each rad or m of the position. All
// vectors are in the world, and NaN if they are not known.
struct JointScrew {
  Vec3 angular = Vec3::Zero(), linear = Vec3::Zero();
  Vec3 origin = Vec3::Zero();
};

// Computes a screw for each position of a joint: variables_of(joint.type) screws. The screws of a
// joint that mimics another refer to the positions of that other joint. `parent` and `child` are
// the links before and behind the joint. They must be placed with these variables, in the order of
// Scene::variables.
void screws_of(const RobotJoint& joint, const LinkState& parent, const LinkState& child,
               std::span<const TrackedVariable> variables, std::span<JointScrew> screws) noexcept;

}  // namespace clearance
