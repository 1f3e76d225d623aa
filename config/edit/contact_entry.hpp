// An allowed contact as an entry of `contacts`.
#pragma once

#include <functional>

#include "config/edit/cell_change.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// `length` writes metres in the unit of the cell.
[[nodiscard]] YamlNode contact_entry(const AllowContact& change,
                                     const std::function<YamlNode(double metres)>& length);

}  // namespace clearance
