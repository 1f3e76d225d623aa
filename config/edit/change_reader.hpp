// Reads changes of a cell that a person has written.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "config/edit/cell_change.hpp"
#include "config/yaml/cell_error.hpp"

namespace clearance {

// A list of changes, or every mistake in its text.
using ChangesResult = std::variant<std::vector<CellChange>, std::vector<CellError>>;

// Reads a YAML list of changes, or a map with such a list under `changes` and the `units` of its
// lengths and angles, which otherwise are m and rad. idl/COMMANDS.md has the changes. Files of
// `replace_cell` are read, and are relative to `file`, which names the text in messages.
[[nodiscard]] ChangesResult read_changes(const std::string& text,
                                         const std::filesystem::path& file);

}  // namespace clearance
