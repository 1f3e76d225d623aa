// Bodies with corners and edges so sharp that a point which is off their sides by no more than
// rounding may be past them by anything, and others that stand exactly where that is so.
#pragma once

#include "tests/shared/hard_cases.hpp"

namespace clearance::hard {

// B: a wedge or needle of 1e-11 to 1 rad whose plane of symmetry is y = 0 or, so that its sides'
// lines cancel, y = 1. A: a corner, an edge or a facet in that plane or ulps beside it, above the
// wedge or past its edge, next to its sharp corner.
[[nodiscard]] HardCase sharp_corners(Random& random);
// A passes the sharp corner, in that plane.
[[nodiscard]] HardMotion past_corners(Random& random, int steps);

}  // namespace clearance::hard
