// Entries of a cell that name others.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "config/edit/cell_document.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// The text of a scalar; empty for other nodes and for none.
[[nodiscard]] std::string text_of(const YamlNode* node);
[[nodiscard]] std::string name_of(const YamlNode& entry);
// The two sides of `between`, in alphabetic order.
[[nodiscard]] std::pair<std::string, std::string> sides_of(const YamlNode& entry);

// Returns what names the object other than by membership: "pairs[arm, box]".
[[nodiscard]] std::vector<std::string> users_of(const std::string& name,
                                                const CellDocument& document);

}  // namespace clearance
