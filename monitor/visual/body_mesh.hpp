// Triangle meshes of convex bodies for viewers: facets are flat, and rounded surfaces are smooth.
//
// A rounded body is tessellated exactly. Each facet is moved outwards by the radius. Each edge gets
// a cylinder strip, and each vertex a sphere patch. For curved bodies see curved_mesh.hpp. Every
// vertex lies on the surface within the rounding of a double. Chords deviate from the surface by at
// most 1 - cos(arc_step / 2) of the radius: 0.4 % with kArcStep. No decision depends on a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/convex_body.hpp"

namespace clearance {

// In the body's frame, m.
struct BodyMesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;                            // per position, unit, outward
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise from outside
  std::vector<std::array<Vec3, 2>> edges;               // the sharp edges, as lines

  bool operator==(const BodyMesh&) const = default;
};

// The default step of arcs, rad.
inline constexpr double kArcStep = 0.175;

// Meshes the body with its radius enlarged by `offset` (m, >= 0). An unbounded body is cut off by
// the cube of half width `reach` (m) around the frame's origin. The mesh is empty if the cube
// contains nothing of the body. Arcs are divided into steps of at most `arc_step` (rad, > 0).
[[nodiscard]] BodyMesh body_mesh(const ConvexBody& body, double offset = 0.0, double reach = 20.0,
                                 double arc_step = kArcStep);

}  // namespace clearance
