#include "monitor/pairs/carried_gap.hpp"

#include <cmath>

#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

// The rounding of the sums here, and of a direction that was rotated from one frame to another,
// relative to the lengths that take part.
constexpr double kError = 0x1p-46;

double rounding_of(double gap, double turning, const PosedPart& a, const PosedPart& b) noexcept {
  return kError * (std::abs(gap) + turning + a.coordinates + b.coordinates);
}

}  // namespace

double kept_gap(double lower, const Vec3& normal, const PosedPart& a, const PosedPart& b) noexcept {
  if (!a.keeps_direction || !b.keeps_direction || normal.isZero(0.0)) return -kInfinity;
  const double turning = a.turning + b.turning;
  const double centres = normal.dot(b.sphere_in_world.centre - a.sphere_in_world.centre);
  const double gap = lower - centres + turning - rounding_of(lower, turning, a, b);
  return std::isfinite(gap) ? gap : -kInfinity;
}

double lower_along(const Vec3& normal, double kept_gap, const PosedPart& a,
                   const PosedPart& b) noexcept {
  const double turning = a.turning + b.turning;
  const double centres = normal.dot(b.sphere_in_world.centre - a.sphere_in_world.centre);
  return kept_gap + centres - turning - rounding_of(kept_gap, turning, a, b);
}

}  // namespace clearance
