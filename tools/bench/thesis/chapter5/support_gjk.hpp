// GJK on support functions, as collision libraries use it for ellipsoids. It keeps a simplex of
// support points of B - A and finds its nearest point to the origin. The next support point is
// taken against that direction.
#pragma once

#include "tools/bench/crossed_ellipsoids.hpp"

namespace clearance::bench {

// Ends when the next support point is nearer by less than this share of the distance (libraries use
// 1e-6), or when rounding prevents any gain.
[[nodiscard]] ClosestPoints support_gjk(const EllipsoidPair& pair, double tolerance,
                                        int most_rounds);

}  // namespace clearance::bench
