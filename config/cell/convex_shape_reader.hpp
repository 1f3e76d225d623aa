// Reads the shapes of a cell file that a few numbers define: every one but meshes.
#pragma once

#include <optional>
#include <string>

#include "config/yaml/map_reader.hpp"
#include "config/yaml/quantities.hpp"
#include "core/shapes.hpp"

namespace clearance {

// Reads the shape under the key `kind`, which is one of ShapeReader::kinds() but not "mesh".
// Reports mistakes in the numbers, and then returns nothing.
[[nodiscard]] std::optional<ShapeResult> read_convex_shape(const std::string& kind,
                                                           const YamlNode& node,
                                                           const Quantities& quantities);

// Reads `rounding: r`, m, which most solids may have: the body is all points within r of the shape.
[[nodiscard]] std::optional<double> read_rounding(MapReader& map, const Quantities& quantities);

}  // namespace clearance
