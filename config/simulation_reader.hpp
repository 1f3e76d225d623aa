// Reads `simulation:`: how the objects move when no robot is there.
#pragma once

#include "config/object_reader.hpp"
#include "config/quantities.hpp"
#include "config/simulation.hpp"

namespace clearance {

[[nodiscard]] Simulation read_simulation(const YamlNode& node, const ObjectList& objects,
                                         const Quantities& quantities);

}  // namespace clearance
