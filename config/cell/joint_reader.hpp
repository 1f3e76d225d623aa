// Reads the exceptions of a cell for single joints of a robot.
#pragma once

#include <string>
#include <vector>

#include "config/scene/robot.hpp"
#include "config/yaml/quantities.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// `joints: {NAME: {age_limit_ms, source, velocity, limits, frozen_limit_ms}}`, by the names of the
// URDF, to which `prefix` is added. Stated values replace those of `variables`.
void read_joints(const YamlNode& node, const std::string& prefix, const Quantities& quantities,
                 std::vector<JointVariable>& variables);

}  // namespace clearance
