// Reads the SRDFs of combinations: which links of a robot and of one that carries it may touch.
#pragma once

#include <span>

#include "config/cell/pair_reader.hpp"
#include "config/scene/revision.hpp"
#include "config/scene/robot.hpp"
#include "config/urdf/robot_files.hpp"
#include "config/yaml/diagnostics.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// Reads `srdf_with: {ROBOT: FILE}` of `robot`, by the names of the robots before it. Each file is
// read and checked. Its pairs go to `may_touch` while that robot carries this one, with `line`.
// Links have their names in the cell, or those of their URDF if only one of both robots has it.
void read_combined_srdfs(const YamlNode& node, const RobotFiles& files,
                         std::span<const Robot> before, int line, Robot& robot,
                         PairExceptions& may_touch, Diagnostics& diagnostics, Revision& revision);

}  // namespace clearance
