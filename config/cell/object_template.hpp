// Reads `templates:`, the named bodies that objects of a cell may have.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/cell/shape_reader.hpp"
#include "config/scene/scene.hpp"

namespace clearance {

// A body that is no object of the scene by itself.
struct ObjectTemplate {
  std::vector<Part> parts;
  std::vector<std::string> groups;
  std::optional<double> margin;  // m; nothing: the default of objects
  double mesh_error = 0.0;       // m, as in ObjectList::mesh_errors
};

// By name.
using ObjectTemplates = std::map<std::string, ObjectTemplate>;

// Reads every template, also those that no object uses: their meshes are then split already.
[[nodiscard]] ObjectTemplates read_templates(const YamlNode& node, const Quantities& quantities,
                                             ShapeReader& shapes);

// Reads names of groups into `groups`. Returns false if one could not be read.
bool read_groups(const YamlNode& node, std::vector<std::string>& groups, Diagnostics& diagnostics);

}  // namespace clearance
