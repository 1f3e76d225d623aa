// Makes one change in the document of a cell.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/edit/cell_change.hpp"
#include "config/edit/cell_document.hpp"

namespace clearance {

// Why a change cannot be made, before any reader sees the result.
struct ChangeFault {
  std::string path, reason;  // as of EditRefusal
};

// The list and the name of an entry that a change makes or edits, to find the change at fault.
struct TouchedEntry {
  std::string list, name;
  friend bool operator==(const TouchedEntry&, const TouchedEntry&) = default;
};

// Does nothing where it returns a fault. Every change but ReplaceCell.
[[nodiscard]] std::optional<ChangeFault> make_change(const CellChange& change,
                                                     CellDocument& document);

// Returns the entry that the change makes or edits.
[[nodiscard]] TouchedEntry touched_by(const CellChange& change);

// Returns what stands for an entry in a path: its name, its two sides, or its place.
[[nodiscard]] std::string entry_label(const YamlNode& entry, std::size_t place);

}  // namespace clearance
