// Parses the bytes of a mesh file with assimp, or PLY with config/mesh/ply.hpp. Call it only where
// a crash does no harm (config/mesh/child_work.hpp): assimp reads out of bounds in some malformed
// files.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "config/decomposition/triangle_mesh.hpp"
#include "config/mesh/mesh_fault.hpp"

namespace clearance {

// Triangles of one colour: red, green, blue from 0 to 1. Nothing: the file states none.
struct ColouredTriangles {
  std::optional<Vec3> colour;
  std::vector<Triangle> triangles;
};

// Returns the triangles of read_mesh(), which calls it in a child process, at least one: by their
// colours in the order in which these occur, and for each colour in the order of the file. Colours
// are the diffuse ones of COLLADA; the other formats have none. `format`: in lower case, without a
// dot.
[[nodiscard]] std::variant<std::vector<ColouredTriangles>, MeshFault> import_mesh(
    const std::string& bytes, const std::string& format);

}  // namespace clearance
