// Splits a mesh into few convex parts that certainly contain it.
//
// A mesh whose hull is within the tolerance stays one part. Any other is cut by planes, repeatedly,
// where hulls hold most open space; pieces that fit together are joined again (K. Mamou, V-HACD; X.
// Wei and others, "Approximate convex decomposition for 3D meshes with collision-aware concavity",
// 2022). The search is approximate, but its result is certified. Every triangle is clipped by the
// planes of its cell, and each part is the exact hull of its points. The cells overlap. The error
// is certified afterwards (surface_error.hpp). The same mesh gives the same parts. A flat mesh
// becomes a plate: the solid between two copies of it.
#pragma once

#include <functional>
#include <variant>
#include <vector>

#include "config/decomposition/part_limits.hpp"
#include "config/decomposition/triangle_mesh.hpp"
#include "core/shapes.hpp"

namespace clearance {

struct ConvexParts {
  // Each part is the hull of its vertices, m.
  std::vector<std::vector<Vec3>> parts;
  // No point of the surface of the parts' union is farther than this from the mesh, m
  // (surface_error.hpp).
  double error = 0.0;
  bool is_hull = false;  // the only part is the mesh's hull: no search was needed
};

// Returns parts whose union holds every triangle of the mesh, or an error where all vertices lie on
// one line.
// `begin` is called before a search that may take seconds.
[[nodiscard]] std::variant<ConvexParts, ShapeError> convex_parts(
    const TriangleMesh& mesh, const PartLimits& limits = {},
    const std::function<void()>& begin = [] {});

}  // namespace clearance
