// How far do convex parts reach beyond the mesh that they contain? A certified bound.
#pragma once

#include <span>

#include "config/decomposition/triangle_tree.hpp"
#include "core/convex_body.hpp"

namespace clearance {

// No point of the surface of the parts' union is farther from the mesh's triangles than this, m.
// What lies within another part is no such surface. So for whatever is not shut in by the mesh, the
// distance from the parts is at most by so much smaller than the distance from the mesh, and a
// cavity may be filled only where no opening is wider than twice as much.
//
// At most 2 % and 1e-6 of the size more than the true value, unless that takes too long. Facets are
// halved where the bound is largest: the distance from one triangle is convex, so that on a piece
// of a facet it is largest at a corner.
[[nodiscard]] double surface_error(std::span<const ConvexBody> parts, const TriangleTree& tree);

}  // namespace clearance
