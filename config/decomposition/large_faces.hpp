// Finds the planes of a mesh's larger flat faces: a good cut often runs along one.
#pragma once

#include <vector>

#include "config/decomposition/triangle_mesh.hpp"
#include "core/shapes.hpp"

namespace clearance {

// Returns the planes by area, the largest first. Triangles within about half of `tolerance`, m, and
// a degree belong to one face.
[[nodiscard]] std::vector<HalfSpace> large_faces(const TriangleMesh& mesh, double tolerance);

}  // namespace clearance
