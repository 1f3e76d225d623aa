// Keeps the convex parts of meshes, so that they are made once.
//
// One folder serves all cells of a folder: clearance.parts beside them, or, where that cannot be
// written, XDG_CACHE_HOME/clearance/parts (default ~/.cache). A file holds the parts of a mesh, a
// scale, a unit and limits, and is called by the hash of all these: KEY.parts. It is text: the key,
// the error, each part's vertices as hexadecimal floating-point numbers, and a checksum. A file
// that is damaged, or is something else, counts as none, and is written anew. So does a folder or
// file that belongs to neither the user nor root.
//
// The checksum finds damage, not a person who wrote the file: who uses the parts checks that they
// contain the mesh (parts_cover.hpp).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/decomposition/convex_parts.hpp"

namespace clearance {

class PartsCache {
 public:
  // `beside`: the folder of the cell, or of the URDF of a robot without a cell. It is not set if
  // there is none, as for the cell of a recording.
  explicit PartsCache(const std::optional<std::filesystem::path>& beside);

  // `key`: the hash of all that decides on the parts.
  [[nodiscard]] std::optional<ConvexParts> find(const std::string& key) const;

  // Returns the folder where they are now; empty: no folder could be written.
  std::filesystem::path keep(const std::string& key, const ConvexParts& parts) const;

  // Returns the folder where parts belong, for messages.
  [[nodiscard]] std::filesystem::path folder() const {
    return folders_.empty() ? "XDG_CACHE_HOME" : folders_.front();
  }

 private:
  std::vector<std::filesystem::path> folders_;  // the first that can be written is
};

}  // namespace clearance
