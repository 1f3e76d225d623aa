// Reads `partner:`, the daemon's name among two that publish side by side (monitor/loop).
#pragma once

#include <string>
#include <string_view>

#include "config/yaml/diagnostics.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// Tells whether a daemon may have this name among partners: 1 to 32 printable ASCII characters
// without blanks. It stands in the announcement of the daemon, between blanks.
[[nodiscard]] bool is_partner_name(std::string_view name) noexcept;

// Returns the name, or an empty one after a diagnostic.
[[nodiscard]] std::string read_partner(const YamlNode& node, Diagnostics& diagnostics);

// Returns the text without the line `partner: NAME` of its top level, if that has a line of its
// own. The texts of two partners differ in that line, and their scenes have the same revision.
[[nodiscard]] std::string without_partner(const YamlNode& document, const std::string& yaml);

}  // namespace clearance
