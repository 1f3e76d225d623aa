// A body as meshes are: vertices closer than rounding are one. The core's exact polyhedron keeps
// them apart (four facets of a facet-ball that meet in a point but for rounding have two vertices
// 1e-16 apart), and solvers that climb along edges in doubles would fail on such edges.
#pragma once

#include <vector>

#include "core/convex_body.hpp"

namespace clearance::bench {

struct Welded {
  std::vector<Vec3> points;
  std::vector<std::vector<int>> faces;  // counter-clockwise as seen from outside
};

[[nodiscard]] Welded welded(const ConvexBody& body);

}  // namespace clearance::bench
