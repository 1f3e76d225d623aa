// The thesis's workload: pairs of facet-balls, or of their duals, on seeded trajectories (§3.5,
// §4.1).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/convex_polyhedron.hpp"
#include "core/pose.hpp"

namespace clearance::bench {

// Facet normals evenly over the sphere: `order` rings from pole to pole, 2 * order facets at the
// equator. Orders 2, 4, 6, 8, 10, 15, 20, 30, 40 have 6, 22, 46, 82, 128, 288, 510, 1148, 2042.
[[nodiscard]] std::vector<Vec3> even_directions(int order);

// The polyhedron of unit radius with those directions as facets ('f') or as vertices ('v').
[[nodiscard]] ConvexPolyhedron ball(char kind, int order);

struct Trajectory {
  std::vector<std::pair<Pose, Pose>> poses;  // world_from_a, world_from_b
};

// `count` trajectories of `steps` steps of 0.02 m and 0.01 rad for each of two bodies of unit
// radius, whose centres come as close as 2.6 to 7 m. The same on every machine.
[[nodiscard]] std::vector<Trajectory> trajectories(int count, int steps);

}  // namespace clearance::bench
