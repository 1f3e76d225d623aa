// Ellipsoids, cylinders and cones, each with a radius around it, as triangles.
#pragma once

#include "core/curved_shape.hpp"
#include "monitor/visual/body_mesh.hpp"

namespace clearance {

// In the shape's frame; `radius` (m, >= 0) is the radius around it.
[[nodiscard]] BodyMesh curved_mesh(const CurvedShape& shape, double radius, double arc_step);

}  // namespace clearance
