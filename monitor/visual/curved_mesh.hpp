// Triangle meshes of ellipsoids, cylinders and cones, each with a radius around it.
#pragma once

#include "core/curved_shape.hpp"
#include "monitor/visual/body_mesh.hpp"

namespace clearance {

// Meshes the shape in its own frame; `radius` (m, >= 0) is the radius around it.
[[nodiscard]] BodyMesh curved_mesh(const CurvedShape& shape, double radius, double arc_step);

}  // namespace clearance
