// From bounds of the bodies without their radii to the answer.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/distance_result.hpp"

namespace clearance {

struct CurvedConclusion {
  double lower = -kInfinity, upper = kInfinity;  // signed, as computed
  double error = 0.0;                            // m: neither bound is off by more
  double size = 0.0;                             // m: of the bodies and what is between them
  double radius_a = 0.0, radius_b = 0.0;         // m
  Vec3 normal = Vec3::Zero();                    // unit, from A to B; this and the points: frame A
  Vec3 point_on_a = Vec3::Zero(), point_on_b = Vec3::Zero();  // on the bodies without radii
};

// From A to B as radii are put on: along the points where the bodies without radii are apart, so
// that what is left of the witness points is as long as the distance.
[[nodiscard]] inline Vec3 radial_direction(const CurvedConclusion& found) noexcept {
  const Vec3 apart = found.point_on_b - found.point_on_a;
  return found.lower > 0.0 && !apart.isZero(0.0) ? unit_along(apart) : found.normal;
}

// Bounds that have converged are within this of each other, by the pair's size.
inline constexpr double kConvergedCurvedGap = 1e-13;

// A point of both bodies where their radii make them overlap, as the points say.
[[nodiscard]] inline Vec3 between(const Vec3& on_a, const Vec3& on_b, double radius_a,
                                  double radius_b) noexcept {
  const double radii = radius_a + radius_b;
  return on_a + (radii > 0.0 ? radius_a / radii : 0.5) * (on_b - on_a);
}

[[nodiscard]] inline DistanceStatus status_of(double lower, double upper, double size) noexcept {
  if (!(upper - lower <= kConvergedCurvedGap * size)) return DistanceStatus::kIterationLimit;
  if (lower > 0.0) return DistanceStatus::kConverged;
  return upper < 0.0 ? DistanceStatus::kOverlapping : DistanceStatus::kTouching;
}

[[nodiscard]] inline DistanceResult conclude(const CurvedConclusion& found) noexcept {
  const double radii = found.radius_a + found.radius_b;
  // The sum of the radii, the error and what is left: 2 ulps of each.
  const auto rounding = [&](double bound) { return 0x1p-51 * (radii + std::abs(bound)); };
  // The points say best how far bodies are apart, and directions how deep they overlap.
  const double best = found.lower < 0.0 ? found.lower : found.upper;
  DistanceResult r;
  r.lower = found.lower - found.error - radii - rounding(found.lower);
  r.upper = found.upper + found.error - radii + rounding(found.upper);
  r.distance = std::clamp(best - radii, r.lower, r.upper);
  r.normal = found.normal;
  r.point_on_a = found.point_on_a;
  r.point_on_b = found.point_on_b;
  if (radii > 0.0) {
    const Vec3 radial = radial_direction(found);
    r.point_on_a += found.radius_a * radial;
    r.point_on_b -= found.radius_b * radial;
  }
  r.path = DistancePath::kDirection;
  r.status = status_of(r.lower, r.upper, found.size + radii);
  return r;
}

}  // namespace clearance
