// A point far inside a ConvexBody, from which queries start.
#pragma once

#include "core/convex_body.hpp"

namespace clearance::exact {

// The centre, unless the body is so thin that doubles lose it; then `known`, which is inside but
// may be far off centre. The centre of an unbounded body is offset from its `anchors` along its
// rays, by the spread of the `anchors`.
[[nodiscard]] Vec3 well_inside(const ConvexBody& body, const Vec3& known);

}  // namespace clearance::exact
