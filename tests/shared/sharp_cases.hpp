// Bodies with very sharp corners and edges, and others close to them. A point may be outside the
// sides by no more than rounding, and yet be any distance past the corner.
#pragma once

#include "tests/shared/hard_cases.hpp"

namespace clearance::hard {

// B is a wedge or a needle of 1e-11 to 1 rad. Its plane of symmetry is y = 0, or y = 1 so that the
// lines of its sides cancel. A has a vertex, an edge or a facet in that plane or ulps beside it. A
// stands above the wedge or past its edge, next to the sharp corner.
[[nodiscard]] HardCase sharp_corners(Random& random);
// A passes the sharp corner of B within the plane of symmetry.
[[nodiscard]] HardMotion past_corners(Random& random, int steps);

}  // namespace clearance::hard
