// Reads the exceptions of a cell for single joints of a robot.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "config/scene/robot.hpp"
#include "config/yaml/quantities.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// `joints: {NAME: {age_limit_ms, source, velocity, limits, frozen_limit_ms, position}}`, by the
// names of the URDF, to which `prefix` is added. Stated values replace those of `variables`.
void read_joints(const YamlNode& node, const std::string& prefix, const Quantities& quantities,
                 std::vector<JointVariable>& variables);

// Reports stated positions outside the limits, once these are known. `node` is that of `joints`.
void refuse_positions_outside(const YamlNode& node, std::span<const JointVariable> variables,
                              Diagnostics& diagnostics);

}  // namespace clearance
