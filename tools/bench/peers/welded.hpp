// A body as a mesh, in which vertices closer than rounding are welded. The core's exact polyhedron
// keeps them separate. For example, four facets of a facet-ball that meet in one point up to
// rounding have two vertices, 1e-16 apart. Solvers that climb along edges in doubles would fail on
// such edges.
#pragma once

#include <vector>

#include "core/convex_body.hpp"

namespace clearance::bench {

struct Welded {
  std::vector<Vec3> points;
  std::vector<std::vector<int>> faces;  // counter-clockwise when viewed from outside
};

[[nodiscard]] Welded welded(const ConvexBody& body);

}  // namespace clearance::bench
