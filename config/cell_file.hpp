// Reads a cell: the YAML file of README's "A cell" into a checked Scene.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "config/scene.hpp"

namespace clearance {

// One thing wrong with a cell file; `text` reads "FILE:LINE:COLUMN: what was found, what was
// expected".
struct CellError {
  std::string text;
};

// Every error that can be found in one pass, never just the first. Mesh paths are relative to the
// file.
using CellResult = std::variant<Scene, std::vector<CellError>>;

// Reads the file. A file that cannot be opened is a CellError at line 1 as well.
[[nodiscard]] CellResult read_cell(const std::filesystem::path& file);

// The same from text; `file` is used in messages and to resolve mesh paths.
[[nodiscard]] CellResult parse_cell(const std::string& yaml, const std::filesystem::path& file);

}  // namespace clearance
