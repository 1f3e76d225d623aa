// The planes of a mesh's larger flat faces: a good cut often runs along one.
#pragma once

#include <vector>

#include "config/decomposition/triangle_mesh.hpp"
#include "core/shapes.hpp"

namespace clearance {

// By area, the largest first. Triangles within about half of `tolerance`, m, and a degree are of
// one face.
[[nodiscard]] std::vector<HalfSpace> large_faces(const TriangleMesh& mesh, double tolerance);

}  // namespace clearance
