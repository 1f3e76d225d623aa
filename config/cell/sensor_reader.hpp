// Reads the sensors of a cell file: cameras that measure depth, and others that measure points.
#pragma once

#include <vector>

#include "config/cell/object_reader.hpp"
#include "config/scene/sensor.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {

// The sensors, and where each of them says that it is mounted: null if it does not.
struct SensorList {
  std::vector<Sensor> sensors;
  std::vector<const YamlNode*> mounts;
  std::vector<const YamlNode*> reaches;  // the key `reach`; null: none
};

// Reads `sensors:`. What each of them sees becomes an object of the list, so this comes before the
// links of robots.
[[nodiscard]] SensorList read_sensors(const YamlNode& node, const ObjectDefaults& defaults,
                                      const Quantities& quantities, ObjectList& objects);

}  // namespace clearance
