// Reads the stated errors of a cell's model: defaults by what is placed, and exceptions.
#pragma once

#include <string>

#include "config/cell/object_reader.hpp"
#include "config/cell/robot_reader.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {

struct Scene;

// Reads `errors:` and states them in robots and objects; those of attached objects and of shapes
// stay in `scene`, too, for objects that are added later. It comes after everything is placed.
void read_errors(const YamlNode& node, const Quantities& quantities, RobotList& robots,
                 ObjectList& list, Scene& scene);

// Refuses errors whose angles add up to more than a chain can have.
void refuse_large_angles(const YamlNode& node, const Scene& scene, Diagnostics& diagnostics);

// One line: the kinds of errors that a cell with stated errors leaves at 0. Empty: none, or the
// cell states no errors.
[[nodiscard]] std::string unstated_errors(const Scene& scene);

}  // namespace clearance
