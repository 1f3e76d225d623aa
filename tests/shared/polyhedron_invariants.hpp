// Does a ConvexBody keep what core/convex_body.hpp promises? For tests of whatever
// makes one.
#pragma once

#include <string>
#include <vector>

#include "core/convex_body.hpp"

namespace clearance {

// One sentence for each promise found broken; geometry is held to the rounding that the body
// declares.
[[nodiscard]] std::vector<std::string> broken_invariants(const ConvexBody& body);

}  // namespace clearance
