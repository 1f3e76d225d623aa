// Pairs at the limits of doubles and of the factories: families of tests/shared/hard_cases.hpp.
#pragma once

#include "tests/shared/hard_cases.hpp"

namespace clearance::hard {

// Columns, slabs, wedges and floors whose lines are exactly parallel. They are rotated about their
// common direction, or all by the same rotation.
[[nodiscard]] HardCase columns(Random& random);

// A needle or a blade that passes through a plate or a needle: shallow in one direction and long in
// the other.
[[nodiscard]] HardCase pierced(Random& random);

// Rods, bars and blades that cross at their middles or lie along each other, rotated by 45 or 90
// degrees about their own axes. Several pairs of edges give the same depth.
[[nodiscard]] HardCase crossed_bars(Random& random);

// Points and segments, with or without radii, inside, on, through and beside bodies and each other.
[[nodiscard]] HardCase bare_cores(Random& random);

}  // namespace clearance::hard
