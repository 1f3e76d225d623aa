// Reads a cell: a YAML file (config/README.md lists its keys) into a checked Cell.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "config/cell/cell.hpp"
#include "config/yaml/cell_error.hpp"

namespace clearance {

// Every error that can be found in one pass, never just the first. Mesh paths are relative to the
// file.
using CellResult = std::variant<Cell, std::vector<CellError>>;

struct CellOptions {
  // Gets lines, without their ends, for the person who waits: which mesh is being split into convex
  // parts, and warnings about them. Empty: the lines are dropped.
  std::function<void(const std::string&)> tell = {};
  // Where wanted: of each object with meshes, by its name, how far from these the surface of its
  // parts is at most, m.
  std::map<std::string, double>* mesh_errors = nullptr;
  // The directory in which the files of another machine stand as they did there, the cell among
  // them; empty: they are this machine's.
  std::filesystem::path root = {};
};

// Reads the file. A file that cannot be opened is a CellError at line 1 as well. The parts of
// meshes are kept beside the file (config/mesh/parts_cache.hpp).
[[nodiscard]] CellResult read_cell(const std::filesystem::path& file,
                                   const CellOptions& options = {});

// The same from text; `file` is used in messages, to resolve mesh paths, and to keep parts beside.
[[nodiscard]] CellResult parse_cell(const std::string& yaml, const std::filesystem::path& file,
                                    const CellOptions& options = {});

}  // namespace clearance
