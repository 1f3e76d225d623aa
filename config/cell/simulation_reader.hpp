// Reads `simulation:`, the simulated motion of the objects.
#pragma once

#include "config/cell/object_reader.hpp"
#include "config/cell/simulation.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {

// Reports objects that do not exist, are fixed, or are moved twice. `objects` may be incomplete
// (names_known false): unknown names are not reported then.
[[nodiscard]] Simulation read_simulation(const YamlNode& node, const ObjectList& objects,
                                         const Quantities& quantities);

}  // namespace clearance
