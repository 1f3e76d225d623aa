// The distance queries of cells along their simulated motion.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "config/cell/cell.hpp"

namespace clearance::bench {

// The cell files in a folder, in the order of their names; says on stderr when it cannot be read.
[[nodiscard]] std::vector<std::filesystem::path> cells_in(const std::filesystem::path& folder);

// Reads a cell file; its mistakes go to stderr.
[[nodiscard]] std::optional<Cell> read_or_say(const std::filesystem::path& file);

// Registers the rows of each cell file.
void register_cells(const std::vector<std::filesystem::path>& cells);

}  // namespace clearance::bench
