// Pairs at the ends of what doubles and the factories take: families of
// tests/shared/hard_cases.hpp.
#pragma once

#include "tests/shared/hard_cases.hpp"

namespace clearance::hard {

// Columns, slabs, wedges and floors whose lines run along each other, exactly: turned about their
// common direction, or all alike, by quaternions of different lengths.
[[nodiscard]] HardCase columns(Random& random);

// The same, leaning against each other by 1e-14 to 1 rad: closest, or meeting, up to 1e17 m away.
[[nodiscard]] HardCase leaning(Random& random);

// The same, leaning by 5e-324 to 1e-100 rad: what only components of a quaternion can say.
[[nodiscard]] HardCase hairs_breadth(Random& random);
// Two of these given by normals with components down to subnormals.
[[nodiscard]] HardCase faint_normals(Random& random);

// Bodies of 1e-120 to 1e80 m, one or both.
[[nodiscard]] HardCase scales(Random& random);

// A needle or a blade through a plate, or through a needle: shallow one way and long the other.
[[nodiscard]] HardCase pierced(Random& random);

// Rods, bars and blades that cross or lie along each other in the middle, turned by 45 or 90
// degrees about their own axes: as deep across several pairs of edges.
[[nodiscard]] HardCase crossed_bars(Random& random);

// Points and segments, with or without radii, in, on, through and beside bodies and each other.
[[nodiscard]] HardCase bare_cores(Random& random);

}  // namespace clearance::hard
