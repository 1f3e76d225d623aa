// Pairs at the ends of what doubles and the factories take: families of
// tests/shared/hard_cases.hpp.
#pragma once

#include "tests/shared/hard_cases.hpp"

namespace clearance::hard {

// Columns, slabs, wedges and floors whose lines run along each other, exactly: turned about their
// common direction, or all alike.
[[nodiscard]] HardCase columns(Random& random);

// A needle or a blade through a plate, or through a needle: shallow one way and long the other.
[[nodiscard]] HardCase pierced(Random& random);

// Rods, bars and blades that cross or lie along each other in the middle, turned by 45 or 90
// degrees about their own axes: as deep across several pairs of edges.
[[nodiscard]] HardCase crossed_bars(Random& random);

// Points and segments, with or without radii, in, on, through and beside bodies and each other.
[[nodiscard]] HardCase bare_cores(Random& random);

}  // namespace clearance::hard
