// Polyhedra become swept-sphere bodies: a body is its polyhedron plus a sphere of its radius.
#pragma once

#include <cmath>

#include "core/distance_result.hpp"
#include "core/numerics/error_constants.hpp"

namespace clearance {

[[nodiscard]] inline double radii(const ConvexBody& a, const ConvexBody& b) noexcept {
  return a.radius + b.radius;
}

// The rounding error, m, when the sum of the radii is subtracted from a bound of about `distance`.
[[nodiscard]] inline double rounding_of_radii(double sum, double distance) noexcept {
  return sum == 0.0 ? 0.0 : kRadiusRounding * (sum + std::abs(distance - sum));
}

// Tells whether the answer will have converged once the radii are subtracted. `gap` is upper less
// lower bound of the polyhedra's distance. The subtraction widens each bound by the rounding error,
// and rounds it by at most as much again. `size`: Precision::size.
[[nodiscard]] inline bool converges_with_radii(const ConvexBody& a, const ConvexBody& b,
                                               double size, double distance, double gap) noexcept {
  const double sum = radii(a, b);
  return gap + 4.0 * rounding_of_radii(sum, distance) <= kConvergedGap * (size + sum);
}

// B's witness point of a result with radii, from the polyhedron's (TrackingState); both and the
// result's normal in the same frame.
[[nodiscard]] inline Vec3 on_rounded_b(const Vec3& on_polyhedron, const Vec3& normal,
                                       const ConvexBody& b) noexcept {
  return on_polyhedron - b.radius * normal;
}

// Witness points move from the polyhedra's surfaces to the rounded bodies'.
inline void add_radii(DistanceResult& r, const ConvexBody& a, const ConvexBody& b) noexcept {
  const double sum = radii(a, b);
  if (sum == 0.0 || r.upper == -kInfinity) return;  // no translation separates these bodies
  const double rounding = rounding_of_radii(sum, r.upper);
  r.distance -= sum;
  r.lower -= sum + rounding;
  r.upper -= sum - rounding;
  r.point_on_a += a.radius * r.normal;
  r.point_on_b = on_rounded_b(r.point_on_b, r.normal, b);
  if (r.upper < 0.0) {
    r.status = DistanceStatus::kOverlapping;
  } else if (r.lower <= 0.0 && r.status == DistanceStatus::kConverged) {
    r.status = DistanceStatus::kTouching;
  }
}

}  // namespace clearance
