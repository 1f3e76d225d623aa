// Plates of nearly no thickness, and pillars of many sides: a family of
// tests/shared/hard_cases.hpp.
#pragma once

#include "tests/shared/hard_cases.hpp"

namespace clearance::hard {

// A plate or a lens of 1e-12 to 1e-9 m, of 57 to 90 facets, and a prism of 240 to 280 corners: the
// one through the other, across its rim, under its end, beside it, or touching.
[[nodiscard]] HardCase foils(Random& random);

}  // namespace clearance::hard
