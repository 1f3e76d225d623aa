// What assimp, or for PLY config/ply.hpp, makes of the bytes of a mesh file. Only to be called
// where a crash does no harm (config/child_work.hpp): assimp itself reads some malformed files out
// of bounds.
#pragma once

#include <string>

#include "config/mesh_file.hpp"

namespace clearance {

// As mesh_vertices(), which calls it in a child process. `format`: in lower case, without a dot.
[[nodiscard]] std::variant<std::vector<Vec3>, MeshFault> import_mesh(const std::string& bytes,
                                                                     const std::string& format);

}  // namespace clearance
