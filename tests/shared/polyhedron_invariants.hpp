// Checks that a ConvexBody satisfies the promises of core/convex_body.hpp. For tests of all its
// factories.
#pragma once

#include <string>
#include <vector>

#include "core/convex_body.hpp"

namespace clearance {

// One sentence for each broken promise. Geometry is checked to the rounding error that the body
// declares.
[[nodiscard]] std::vector<std::string> broken_invariants(const ConvexBody& body);

}  // namespace clearance
