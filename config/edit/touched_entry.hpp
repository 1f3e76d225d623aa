// Names the entry that a change edits, for the path of a mistake.
#pragma once

#include <cstddef>
#include <string>

#include "config/edit/cell_change.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// The list and the name of an entry that a change makes or edits, to find the change at fault.
struct TouchedEntry {
  std::string list, name;
  friend bool operator==(const TouchedEntry&, const TouchedEntry&) = default;
};

// Returns the entry that the change makes or edits.
[[nodiscard]] TouchedEntry touched_by(const CellChange& change);

// Returns what stands for an entry in a path: its name, its two sides, or its place.
[[nodiscard]] std::string entry_label(const YamlNode& entry, std::size_t place);

}  // namespace clearance
