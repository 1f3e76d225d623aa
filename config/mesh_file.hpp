// Vertices of a mesh file: STL, OBJ, PLY, DAE.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/vec.hpp"

namespace clearance {

// The end of a sentence: "'x.stl' cannot be opened: ...".
struct MeshFault {
  std::string reason;
};

// The bytes of a file, at most 256 MiB, or why there are none.
[[nodiscard]] std::variant<std::string, MeshFault> read_bytes(const std::string& path);

// Every distinct vertex that a face uses, placed by the file's scene graph, in the file's own unit
// (for DAE: metres, as its <unit> says) and axes (a DAE's up-axis is ignored, as in ROS); finite,
// and otherwise unchecked: the caller knows how large a body may be. Single precision: that is what
// assimp keeps. `extension` is the path's, with or without the dot. Never throws.
//
// The file is read in a child process (config/child_work.hpp): bytes that crash assimp, or lead it
// to read for ever, are a fault like any other.
[[nodiscard]] std::variant<std::vector<Vec3>, MeshFault> mesh_vertices(
    const std::string& bytes, const std::string& extension);

}  // namespace clearance
