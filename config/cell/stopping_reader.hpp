// Reads `stopping:` of a robot: how it stops, by the maker's table, by decelerations, or by a time.
#pragma once

#include <filesystem>
#include <span>

#include "config/scene/revision.hpp"
#include "config/scene/robot.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {

// The robot has its joints and `variables` its limits: speeds of tables are shares of them. `cell`:
// the cell file, beside which the table is.
void read_stopping(const YamlNode& node, const std::filesystem::path& cell,
                   const Quantities& quantities, Revision& revision,
                   std::span<const JointVariable> variables, Robot& robot);

}  // namespace clearance
