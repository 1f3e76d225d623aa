// Plates of almost no thickness and pillars with many sides: a family of
// tests/shared/hard_cases.hpp.
#pragma once

#include "tests/shared/hard_cases.hpp"

namespace clearance::hard {

// A plate or a lens of 1e-12 to 1e-9 m with 57 to 90 facets, and a prism with 240 to 280 vertices.
// The prism passes through the plate, crosses its rim, ends on it, stands beside it or touches it.
[[nodiscard]] HardCase foils(Random& random);

}  // namespace clearance::hard
