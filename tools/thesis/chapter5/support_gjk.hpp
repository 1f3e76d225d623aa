// GJK on support functions, as collision libraries have it for ellipsoids: a simplex of support
// points of B - A, its nearest point to the origin, the next support point against that.
#pragma once

#include "tools/bench/crossed_ellipsoids.hpp"

namespace clearance::bench {

// Ends when the next support point is nearer by less than this share of the distance (libraries use
// 1e-6), or when rounding lets it gain nothing.
[[nodiscard]] ClosestPoints support_gjk(const EllipsoidPair& pair, double tolerance,
                                        int most_rounds);

}  // namespace clearance::bench
