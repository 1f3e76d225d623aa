// The triangles of a mesh file: STL, OBJ, PLY, DAE.
#pragma once

#include <string>
#include <variant>

#include "config/decomposition/triangle_mesh.hpp"
#include "config/mesh/mesh_fault.hpp"

namespace clearance {

// Every triangle of the mesh, once, and its vertices, placed by the file's scene graph, in the
// file's own unit (for DAE: metres, as its <unit> says) and axes (a DAE's up-axis is ignored, as in
// ROS); at least one; finite, and otherwise unchecked: the caller knows how large a body may be.
// Polygons are fans of triangles, which cover them. Single precision: that is what assimp keeps.
// Their order depends on the coordinates only. `extension` is the path's, with or without the dot.
// Never throws.
//
// The file is read in a child process (config/mesh/child_work.hpp): bytes that crash assimp, or
// lead it to read for ever, are a fault like any other.
[[nodiscard]] std::variant<TriangleMesh, MeshFault> read_mesh(const std::string& bytes,
                                                              const std::string& extension);

}  // namespace clearance
