// Splits a mesh into its shells: the triangles that hang together by edges. A solid that only
// touches others, or crosses them, is a shell of its own.
#pragma once

#include <vector>

#include "config/decomposition/triangle_mesh.hpp"

namespace clearance {

// Two triangles at an edge belong to one shell. If more meet there, as where solids share an edge,
// those belong together that have the solid between them. The faces of a shell are turned
// outwards. Vertices at the same place are one. The shells are in the order of their first
// triangles.
[[nodiscard]] std::vector<TriangleMesh> shells_of(const TriangleMesh& mesh);

}  // namespace clearance
