// Does a ConvexPolyhedron keep what core/convex_polyhedron.hpp promises? For tests of whatever
// makes one.
#pragma once

#include <string>
#include <vector>

#include "core/convex_polyhedron.hpp"

namespace clearance {

// One sentence for each promise found broken; geometry is held to the rounding that the body
// declares.
[[nodiscard]] std::vector<std::string> broken_invariants(const ConvexPolyhedron& body);

}  // namespace clearance
