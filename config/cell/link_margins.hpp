// Reads `margins:` of a cell: margins of single links of robots.
#pragma once

#include "config/cell/object_reader.hpp"
#include "config/cell/robot_reader.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {

// An entry replaces the margin that its robot gives to all of its links. A link without shapes is
// accepted, and has nothing that a margin could be around.
void read_link_margins(const YamlNode& node, const RobotList& robots, const Quantities& quantities,
                       ObjectList& list);

}  // namespace clearance
