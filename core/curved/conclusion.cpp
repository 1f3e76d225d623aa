#include "core/curved/conclusion.hpp"

#include <algorithm>
#include <cmath>

namespace clearance {
namespace {

DistanceStatus status_of(const DistanceResult& r, double size) noexcept {
  if (!(r.upper - r.lower <= kConvergedCurvedGap * size)) return DistanceStatus::kIterationLimit;
  if (r.lower > 0.0) return DistanceStatus::kConverged;
  return r.upper < 0.0 ? DistanceStatus::kOverlapping : DistanceStatus::kTouching;
}

}  // namespace

Vec3 radial_direction(const CurvedConclusion& found) noexcept {
  const Vec3 apart = found.point_on_b - found.point_on_a;
  return found.lower > 0.0 && !apart.isZero(0.0) ? unit_along(apart) : found.normal;
}

Vec3 between(const Vec3& on_a, const Vec3& on_b, double radius_a, double radius_b) noexcept {
  const double radii = radius_a + radius_b;
  return on_a + (radii > 0.0 ? radius_a / radii : 0.5) * (on_b - on_a);
}

DistanceResult conclude(const CurvedConclusion& found) noexcept {
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
  const Vec3 radial = radial_direction(found);
  r.point_on_a = found.point_on_a + found.radius_a * radial;
  r.point_on_b = found.point_on_b - found.radius_b * radial;
  r.path = DistancePath::kDirection;
  r.status = status_of(r, found.size + radii);
  return r;
}

}  // namespace clearance
