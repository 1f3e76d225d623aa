// Triangles of a mesh file for viewers: smooth where faces meet at small angles, with an edge where
// they do not.
#pragma once

#include "config/decomposition/triangle_mesh.hpp"
#include "monitor/visual/body_mesh.hpp"

namespace clearance {

// The mesh with normals, without the triangles that have no area. A normal is the mean of the faces
// around a vertex whose planes differ by at most 40 degrees from that of the triangle, weighted by
// their areas. A vertex occurs once for each different normal. `edges` stays empty.
[[nodiscard]] BodyMesh smooth_mesh(const TriangleMesh& mesh);

}  // namespace clearance
