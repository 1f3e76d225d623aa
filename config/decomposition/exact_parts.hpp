// Recognises the convex solids that a mesh is made of.
#pragma once

#include <vector>

#include "config/decomposition/open_space.hpp"
#include "config/decomposition/part_limits.hpp"
#include "config/decomposition/piece.hpp"
#include "config/decomposition/triangle_mesh.hpp"
#include "core/convex_body.hpp"

namespace clearance {

// The cells hold all of the mesh, and those of convex pieces come before all others.
struct ConvexPieces {
  std::vector<ConvexCell> cells;
  std::size_t convex = 0;  // number of cells whose piece is convex
  std::size_t shells = 0;  // number of shells of the mesh
};

// Every shell that is its own hull is convex; others are cut into walls (walls.hpp). A shell within
// a convex one is left out. `shells`: of the mesh (shells.hpp); the result points to them. `space`
// is that of the mesh.
[[nodiscard]] ConvexPieces convex_pieces(const std::vector<TriangleMesh>& shells,
                                         const OpenSpace& space, const PartLimits& limits);

// Returns the hull of each piece, without those that lie in another. Returns nothing if a piece is
// not convex, or a triangle of the mesh is whole in none of the hulls.
[[nodiscard]] std::vector<ConvexBody> exact_parts(const ConvexPieces& pieces,
                                                  const TriangleMesh& mesh, const OpenSpace& space);

}  // namespace clearance
