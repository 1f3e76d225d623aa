// An allowed contact as an entry of `contacts`.
#pragma once

#include <functional>

#include "config/edit/cell_change.hpp"
#include "config/edit/cell_document.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// Appends the entry, or replaces that of the same name. `length` writes metres in the unit of the
// cell.
void allow_contact(const AllowContact& change, const std::function<YamlNode(double metres)>& length,
                   CellDocument& document);

}  // namespace clearance
