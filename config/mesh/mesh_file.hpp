// Reads the triangles of a mesh file: STL, OBJ, PLY, DAE.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "config/decomposition/triangle_mesh.hpp"
#include "config/mesh/mesh_fault.hpp"

namespace clearance {

// Returns every triangle of the mesh, once, and its vertices: at least one, and finite. The file's
// scene graph places them, in the file's own unit and axes. A DAE is converted to metres by its
// <unit>, and its up-axis is ignored, as in ROS. The caller knows how large a body may be. Polygons
// become fans of triangles, which cover them. Coordinates have single precision, as assimp keeps
// them, and their order depends on nothing else. `extension` is the path's, with or without the
// dot. Never throws.
//
// The file is read in a child process (config/mesh/child_work.hpp): bytes that crash assimp, or
// that it never finishes, are a fault like any other.
[[nodiscard]] std::variant<TriangleMesh, MeshFault> read_mesh(const std::string& bytes,
                                                              const std::string& extension);

// The triangles of one colour: red, green, blue from 0 to 1. Nothing: the file states none.
struct ColouredMesh {
  std::optional<Vec3> colour;
  TriangleMesh mesh;
};

// The same triangles by their colours, for pictures only. Only a DAE states colours.
[[nodiscard]] std::variant<std::vector<ColouredMesh>, MeshFault> read_coloured_mesh(
    const std::string& bytes, const std::string& extension);

}  // namespace clearance
