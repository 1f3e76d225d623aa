// Writes lengths and poses as YAML, in the unit of a cell.
#pragma once

#include <span>
#include <string>

#include "config/yaml/quantities.hpp"
#include "config/yaml/yaml_node.hpp"
#include "core/pose.hpp"

namespace clearance {

// Returns the unit that the tree of a cell states; metres if it states none that is known.
[[nodiscard]] LengthUnit length_unit_of(const YamlNode& cell);

// A length in metres, as a number of this unit. Reading it gives the same length, or one within one
// rounding of it.
[[nodiscard]] YamlNode length_node(double metres, LengthUnit unit);
// Lengths as a list.
[[nodiscard]] YamlNode lengths_node(std::span<const double> metres, LengthUnit unit);
// {xyz: ..., quaternion: ...}, without the quaternion if nothing is turned.
[[nodiscard]] YamlNode pose_node(const Pose& pose, LengthUnit unit);

}  // namespace clearance
