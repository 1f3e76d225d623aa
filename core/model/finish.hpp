// Turns the answer of a method into the result of a query: adds radii, decides the status, and
// checks the promises of DistanceResult.
#pragma once

#include <cassert>

#include "core/model/query.hpp"
#include "core/model/radii.hpp"
#include "core/model/result_invariants.hpp"

namespace clearance {

// Bodies without radii become bodies with them. `outward`: unit, the direction from A to B in which
// the witness points move. Converged bounds say by their signs whether the bodies touch or overlap.
// Always inlined, as precision() is.
[[gnu::always_inline]] inline void finish(const ConvexBody& a, const ConvexBody& b,
                                          const Vec3& outward, Answer& r) noexcept {
  const double sum = radii(a, b);
  assert(r.upper != -kInfinity);
  if (sum != 0.0) {
    const double rounding = rounding_of_radii(sum, r.upper);
    r.distance -= sum;
    r.lower -= sum + rounding;
    r.upper -= sum - rounding;
    r.point_on_a += a.radius * outward;
    r.point_on_b = on_rounded_b(r.point_on_b, outward, b);
  }
  // A depth that has not converged stays kIterationLimit. Only that of curved bodies may be so.
  const bool wide_depth =
      r.status == DistanceStatus::kIterationLimit && r.path == DistancePath::kDirection;
  const bool is_open = wide_depth || r.status == DistanceStatus::kDepthNotAsked;
  if (!(r.lower > 0.0) && !is_open) {
    if (r.upper < 0.0) {
      r.status = DistanceStatus::kOverlapping;
    } else if (r.status == DistanceStatus::kConverged) {
      r.status = DistanceStatus::kTouching;
    }
  }
  assert(keeps_promises(r));
}

}  // namespace clearance
