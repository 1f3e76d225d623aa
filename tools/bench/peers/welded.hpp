// A body as a mesh, in which vertices closer than rounding are welded. The core's exact polyhedron
// keeps them separate. For example, four facets of a facet-ball that meet in one point up to
// rounding have two vertices, 1e-16 apart. Solvers that climb along edges in doubles would fail on
// such edges.
#pragma once

#include <optional>
#include <vector>

#include "core/convex_body.hpp"

namespace clearance::bench {

struct Welded {
  std::vector<Vec3> points;
  std::vector<std::vector<int>> faces;  // counter-clockwise when viewed from outside
};

[[nodiscard]] Welded welded(const ConvexBody& body);

// The half extents of a box around the origin with sides along the axes, for which libraries have a
// shape of their own. Empty for any other body, and for a box with a radius.
[[nodiscard]] std::optional<Vec3> box_half_extents(const ConvexBody& body);

}  // namespace clearance::bench
