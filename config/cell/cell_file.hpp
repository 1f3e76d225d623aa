// Reads a YAML file (config/README.md lists its keys) into a checked Cell.
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

// A cell, or every error that can be found in one pass. Mesh paths are relative to the file.
using CellResult = std::variant<Cell, std::vector<CellError>>;

struct CellOptions {
  // Called with lines, without their ends, for a person who waits: the mesh that is being split,
  // and warnings. Empty: the lines are dropped.
  std::function<void(const std::string&)> tell = {};
  // If not null: filled, for each object with meshes, by its name, with the largest distance of the
  // surface of its parts from the meshes, m.
  std::map<std::string, double>* mesh_errors = nullptr;
  // The text was made from the URDF `file`: mistakes name its lines; advice: how to get a cell.
  bool is_of_urdf = false;
  // The directory that holds the files of another machine, the cell among them, at their paths
  // there; empty: they are this machine's.
  std::filesystem::path root = {};
};

// Reads the file. A file that cannot be opened is a CellError at line 1. The parts of meshes are
// kept beside it (config/mesh/parts_cache.hpp).
[[nodiscard]] CellResult read_cell(const std::filesystem::path& file,
                                   const CellOptions& options = {});

// The same from text. Messages name `file`, and its folder is that of mesh paths and kept parts.
[[nodiscard]] CellResult parse_cell(const std::string& yaml, const std::filesystem::path& file,
                                    const CellOptions& options = {});

}  // namespace clearance
