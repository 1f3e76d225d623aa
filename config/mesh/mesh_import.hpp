// What assimp, or for PLY config/mesh/ply.hpp, makes of the bytes of a mesh file. Only to be called
// where a crash does no harm (config/mesh/child_work.hpp): assimp itself reads some malformed files
// out of bounds.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "config/decomposition/triangle_mesh.hpp"
#include "config/mesh/mesh_fault.hpp"

namespace clearance {

// The triangles as read_mesh() gives them, which calls it in a child process, in the order of the
// file. `format`: in lower case, without a dot.
[[nodiscard]] std::variant<std::vector<Triangle>, MeshFault> import_mesh(const std::string& bytes,
                                                                         const std::string& format);

}  // namespace clearance
