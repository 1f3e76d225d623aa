// Reads PLY, ASCII and binary. Assimp is not used here. It never finishes a file whose header is
// cut off. If a file is cut off later, assimp reads it as if it were complete.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "config/decomposition/triangle_mesh.hpp"
#include "config/mesh/mesh_fault.hpp"

namespace clearance {

// Returns the faces of three or more vertices as fans of triangles, in the file's order. It reads
// the elements `vertex` (x, y, z) and `face` (vertex_indices or vertex_index), and skips others.
// Every index and count is checked.
[[nodiscard]] std::variant<std::vector<Triangle>, MeshFault> ply_triangles(
    const std::string& bytes);

}  // namespace clearance
