// Certifies the largest distance by which convex parts exceed the mesh that they contain.
#pragma once

#include <span>

#include "config/decomposition/triangle_tree.hpp"
#include "core/convex_body.hpp"

namespace clearance {

// Returns a bound, m: no point of the surface of the parts' union is farther from the mesh's
// triangles. Faces inside another part are not surface. For a body outside the mesh, the distance
// from the parts is therefore less than that from the mesh by at most the bound. A cavity may be
// filled only where no opening is wider than twice the bound.
//
// The bound exceeds the true value by at most 2 % and 5e-10 of the size; where that takes long, by
// 2 % and 1e-6 of the size or `precise`; and by more only where that takes too long.
// Facets are halved where the bound is largest. The distance from one triangle is convex, so on a
// triangle within a facet it is largest at a vertex. What of a facet lies in a plane with triangles
// of the mesh is compared with these polygon by polygon, so that exact parts have no error but
// rounding.
//
// `precise`, m: an error that takes long is found only up to this. `enough`, m: the search ends
// when the error is certainly larger.
[[nodiscard]] double surface_error(std::span<const ConvexBody> parts, const TriangleTree& tree,
                                   double precise = 0.0, double enough = kInfinity);

}  // namespace clearance
