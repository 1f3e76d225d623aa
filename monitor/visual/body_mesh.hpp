// A convex body as triangles, for viewers: facets are flat, and surfaces at a radius are smooth.
//
// Rounded bodies are tessellated exactly: each facet moved out by the radius, a strip of a cylinder
// along each edge, a patch of a sphere at each vertex; curved_mesh.hpp does curved bodies. Every
// vertex lies on the surface within a double's rounding. Chords leave it by at most 1 -
// cos(arc_step / 2) of the radius: 0.4 % with kArcStep. No decision rests on a mesh.
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
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
  std::vector<std::array<Vec3, 2>> edges;               // sharp ones, as lines

  bool operator==(const BodyMesh&) const = default;
};

// The default step of arcs, rad.
inline constexpr double kArcStep = 0.175;

// The body with its radius enlarged by `offset` (m, >= 0). An unbounded body is cut off by the cube
// of half width `reach` (m) around the frame's origin; the mesh is empty when nothing lies in it.
// Arcs are cut into steps of at most `arc_step` (rad, > 0).
[[nodiscard]] BodyMesh body_mesh(const ConvexBody& body, double offset = 0.0, double reach = 20.0,
                                 double arc_step = kArcStep);

}  // namespace clearance
