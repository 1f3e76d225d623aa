// Keeps the convex parts of meshes beside the cell, so that they are made once.
//
// A file a mesh, scale, unit and limits: CELL.yaml.parts/NAME-KEY.parts, or, where that cannot be
// written, XDG_CACHE_HOME/clearance/parts (default ~/.cache). Text: the key, the error, each part's
// vertices as hexadecimal floating-point numbers, and a checksum. A file that is damaged counts as
// none, and is written anew.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/decomposition/convex_parts.hpp"

namespace clearance {

class PartsCache {
 public:
  // `cell`: the file that the cell was read from, or the URDF of a robot without one; empty: there
  // is no folder beside it, as for the cell of a recording.
  explicit PartsCache(const std::filesystem::path& cell);

  // `name`: of the mesh file without its folder; `key`: of all that decides on the parts.
  [[nodiscard]] std::optional<ConvexParts> find(const std::string& name,
                                                const std::string& key) const;

  // The folder where they are now; empty: neither could be written.
  std::filesystem::path keep(const std::string& name, const std::string& key,
                             const ConvexParts& parts) const;

  // Where they belong, for messages.
  [[nodiscard]] std::filesystem::path folder() const {
    return folders_.empty() ? "XDG_CACHE_HOME" : folders_.front();
  }

 private:
  std::vector<std::filesystem::path> folders_;  // the first that can be written is
};

}  // namespace clearance
