// Reads `dds:`, the place of the daemon on DDS, the names of its topics, and what reports carry.
#pragma once

#include "config/cell/cell.hpp"
#include "config/yaml/diagnostics.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// The command line overrides the domain and the partition.
void read_dds(const YamlNode& node, Cell& cell, Diagnostics& diagnostics);

}  // namespace clearance
