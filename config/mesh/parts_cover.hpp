// Checks that convex parts contain a mesh.
#pragma once

#include <span>

#include "config/decomposition/triangle_mesh.hpp"
#include "core/convex_body.hpp"

namespace clearance {

// Returns true if every point of every triangle lies within one of the parts, or is outside by no
// more than rounding: 1e-9 of the mesh's largest coordinate. A triangle may be divided among
// several parts. The parts are bounded polyhedra; both are in the same frame, in metres.
[[nodiscard]] bool cover(std::span<const ConvexBody> parts, const TriangleMesh& mesh);

}  // namespace clearance
