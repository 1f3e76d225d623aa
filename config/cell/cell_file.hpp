// Reads a YAML file (config/KEYS.md lists its keys) into a checked Cell.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "config/cell/cell.hpp"
#include "config/scene/revision.hpp"
#include "config/yaml/cell_error.hpp"

namespace clearance {

struct YamlNode;
struct MeshesAhead;

// A cell, or every error that can be found in one pass. Mesh paths are relative to the file.
using CellResult = std::variant<Cell, std::vector<CellError>>;

struct CellOptions {
  // Receives progress messages and warnings, one line a call and without a line end: for example,
  // which mesh is being split. If empty, the messages are dropped.
  std::function<void(const std::string&)> tell = {};
  // If not null, receives for each object with meshes, by name, the largest distance (m) between
  // the surface of its parts and the meshes.
  std::map<std::string, double>* mesh_errors = nullptr;
  // True when the text was generated from the URDF `file`. Mistakes then name its lines, and advice
  // says how to get a cell.
  bool is_of_urdf = false;
  // A directory with the files of another machine, including the cell, at the paths that they have
  // there. If empty, the files are this machine's own.
  std::filesystem::path root = {};
  // The share of the cell to which it is reduced (select_share). If empty, it stays whole.
  std::string share = {};
  MayRead may_read = {};  // may be empty; not asked of the cell's own file
  // If not null, meshes come from another thread where it asks for that. A reading that wants some
  // has found no mistake, but its cell has stand-ins and must not be used.
  MeshesAhead* meshes_ahead = nullptr;
};

// Reads a cell again and again, as changes edit its YAML tree. Bodies, meshes and their parts that
// the last readings had are not made again. Files that were read are not read again, except the
// URDFs, SRDFs and planning scenes.
class CellReadings {
 public:
  // `file` and `options` as for parse_cell(); what the options refer to must outlive this.
  explicit CellReadings(std::filesystem::path file, CellOptions options = {});
  ~CellReadings();
  CellReadings(CellReadings&&) noexcept;
  CellReadings& operator=(CellReadings&&) noexcept;

  // `document` is the tree of the text `yaml`. The lines of mistakes are those of the tree's nodes.
  [[nodiscard]] CellResult read(const YamlNode& document, const std::string& yaml);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Reads the file. A file that cannot be opened is a CellError at line 1. The parts of meshes are
// kept beside it (config/mesh/parts_cache.hpp).
[[nodiscard]] CellResult read_cell(const std::filesystem::path& file,
                                   const CellOptions& options = {});

// Reads a cell from text. `file` stands for the file in messages; mesh paths are relative to its
// folder, and parts are kept there.
[[nodiscard]] CellResult parse_cell(const std::string& yaml, const std::filesystem::path& file,
                                    const CellOptions& options = {});

}  // namespace clearance
