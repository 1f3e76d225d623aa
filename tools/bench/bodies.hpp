// The bodies that the workloads move.
#pragma once

#include <vector>

#include "core/convex_body.hpp"
#include "core/shapes.hpp"
#include "tools/bench/random.hpp"

namespace clearance::bench {

// Facet normals evenly over the sphere: `order` rings from pole to pole, 2 * order facets at the
// equator (§3.5). Orders 2, 4, 6, 8, 10, 15, 20, 30, 40 have 6, 22, 46, 82, 128, 288, 510, 1148,
// 2042.
[[nodiscard]] std::vector<Vec3> even_directions(int order);
[[nodiscard]] std::vector<HalfSpace> ball_rows(int order);

// The polyhedron of unit radius with those directions as facets ('f') or as vertices ('v').
[[nodiscard]] ConvexBody ball(char kind, int order);

// Half extents from 0.05 to 0.5 m.
[[nodiscard]] ConvexBody random_box(Random& random);

// A body like the hull of a robot's link: 0.2 to 0.5 m long, with four rings of `around` vertices.
// The outer rings are narrower, and the ends differ in width. With twelve it has 48 vertices and
// about 40 facets.
[[nodiscard]] ConvexBody random_link(Random& random, int around = 12);

}  // namespace clearance::bench
