// §5.4: polyhedra around the ellipsoids that get more facets where they are closest.
#pragma once

#include "tools/bench/crossed_ellipsoids.hpp"

namespace clearance::bench {

// Facets added to each body in a cycle. The first is at the nearest point of the ellipsoid, the
// second at the normal along the distance. Two more are on the circle around the first through the
// second. If seven are added, three more are on a circle twice as wide.
enum class Cluster { kFour, kSeven };

// The points are those of the ellipsoids nearest to the polyhedra's closest points. Ends after so
// many cycles, or when both polyhedra touch their ellipsoids there to rounding; not converged if
// the quadratic programme did not end.
[[nodiscard]] ClosestPoints refine(const EllipsoidPair& pair, Cluster cluster, int most_cycles);

}  // namespace clearance::bench
