// A point well inside a ConvexBody, for queries to set out from.
#pragma once

#include "core/convex_body.hpp"

namespace clearance::exact {

// The centre, unless the body is so thin that doubles lose it; `known` is inside but may be far off
// centre. The centre of an unbounded body lies along its rays from the anchors, by the spread of
// the anchors.
[[nodiscard]] Vec3 well_inside(const ConvexBody& body, const Vec3& known);

}  // namespace clearance::exact
