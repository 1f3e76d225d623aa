// Reads PLY, ASCII and binary. Our own: assimp reads for ever what is cut off in its header, and
// takes what is cut off behind it for a whole mesh.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "config/decomposition/triangle_mesh.hpp"
#include "config/mesh/mesh_fault.hpp"

namespace clearance {

// The faces of three or more corners as fans of triangles, in the file's order. Elements `vertex`
// (x, y, z) and `face` (vertex_indices or vertex_index); others are read over. Every index and
// count is checked.
[[nodiscard]] std::variant<std::vector<Triangle>, MeshFault> ply_triangles(
    const std::string& bytes);

}  // namespace clearance
