// From the cores to the bodies: each is its core plus a ball of its radius.
#pragma once

#include <cmath>

#include "core/distance.hpp"
#include "core/rounding.hpp"

namespace clearance {

[[nodiscard]] inline double radii(const ConvexPolyhedron& a, const ConvexPolyhedron& b) noexcept {
  return a.radius + b.radius;
}

// B's witness point of a result with radii, from the core's (TrackingState); both and the result's
// normal in the same frame.
[[nodiscard]] inline Vec3 on_rounded_b(const Vec3& on_core, const Vec3& normal,
                                       const ConvexPolyhedron& b) noexcept {
  return std::isfinite(normal.x()) ? Vec3(on_core - b.radius * normal) : on_core;
}

// Witness points move from the cores' surfaces to the rounded bodies'.
inline void add_radii(DistanceResult& r, const ConvexPolyhedron& a,
                      const ConvexPolyhedron& b) noexcept {
  const double sum = radii(a, b);
  if (sum == 0.0 || r.upper == -kInfinity) return;  // what no translation parts stays so
  const double rounding = kRadiusRounding * (sum + std::abs(r.upper - sum));
  r.distance -= sum;
  r.lower -= sum + rounding;
  r.upper -= sum - rounding;
  if (std::isfinite(r.normal.x())) {
    r.point_on_a += a.radius * r.normal;
    r.point_on_b = on_rounded_b(r.point_on_b, r.normal, b);
  }
  if (r.upper < 0.0) {
    r.status = DistanceStatus::kOverlapping;
  } else if (r.lower <= 0.0 && r.status == DistanceStatus::kConverged) {
    r.status = DistanceStatus::kTouching;
  }
}

}  // namespace clearance
