// Parses the bytes of a mesh file with assimp, or PLY with config/mesh/ply.hpp. Call it only where
// a crash does no harm (config/mesh/child_work.hpp): assimp reads out of bounds in some malformed
// files.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "config/decomposition/triangle_mesh.hpp"
#include "config/mesh/mesh_fault.hpp"

namespace clearance {

// Returns the triangles of read_mesh(), which calls it in a child process, in the order of the
// file. `format`: in lower case, without a dot.
[[nodiscard]] std::variant<std::vector<Triangle>, MeshFault> import_mesh(const std::string& bytes,
                                                                         const std::string& format);

}  // namespace clearance
