// Reads what a cell says of single joints of a robot.
#pragma once

#include <string>
#include <vector>

#include "config/scene/robot.hpp"
#include "config/yaml/quantities.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// `joints: {NAME: {age_limit_ms, source, velocity}}`: by the names of the URDF, to which `prefix`
// is added. What is stated replaces what `variables` have.
void read_joints(const YamlNode& node, const std::string& prefix, const Quantities& quantities,
                 std::vector<JointVariable>& variables);

}  // namespace clearance
