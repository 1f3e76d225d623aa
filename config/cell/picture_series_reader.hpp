// Reads what a sensor's key says of several pictures in a row.
#pragma once

#include "config/scene/sensor.hpp"
#include "config/yaml/diagnostics.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// 'persist': in how many of the last frames an element has to be.
void read_persistence(const YamlNode& node, Diagnostics& diagnostics, Sensor& sensor);
// 'witness': true, or a map that states what it takes.
void read_witness(const YamlNode& node, Diagnostics& diagnostics, Sensor& sensor);

}  // namespace clearance
