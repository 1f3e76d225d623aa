// The radii of swept-sphere bodies: a body is its polyhedron plus a sphere of its radius.
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

}  // namespace clearance
