// Reads what a cell says of the stops of single joints, and of all joints alike.
#pragma once

#include "config/cell/stopped_joints.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {

// The values of these keys of `stopping`; null: not there.
struct StopsOfJoints {
  const YamlNode* joints = nullptr;
  const YamlNode* time = nullptr;
  const YamlNode* deceleration = nullptr;
  const YamlNode* acceleration = nullptr;
};

// Reads the stops of joints. That of a single joint replaces its stop by a table; one for all
// joints counts for those that have none.
void read_joint_stops(const StopsOfJoints& stated, const Quantities& quantities,
                      StoppedJoints& joints);

}  // namespace clearance
