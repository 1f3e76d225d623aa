#include "monitor/carried_direction.hpp"

#include <cmath>

#include "monitor/rounding.hpp"

namespace clearance {
namespace {

// Of the sums here and of the direction, rounded from one frame to another: relative to the lengths
// that take part.
constexpr double kError = 0x1p-46;

double swept_by(const PlacedPart& part) noexcept {
  return swept(part.turned, part.ball_in_part.radius);
}

double sizes(const PlacedPart& a, const PlacedPart& b) noexcept {
  return a.ball_in_world.centre.lpNorm<1>() + a.world_from_part.position.lpNorm<1>() +
         b.ball_in_world.centre.lpNorm<1>() + b.world_from_part.position.lpNorm<1>();
}

}  // namespace

double kept_gap(double lower, const Vec3& normal, const PlacedPart& a,
                const PlacedPart& b) noexcept {
  if (!a.keeps_direction || !b.keeps_direction) return -kInfinity;
  const double turned = swept_by(a) + swept_by(b);
  const double middles = normal.dot(b.ball_in_world.centre - a.ball_in_world.centre);
  const double gap = lower - middles + turned - kError * (std::abs(lower) + turned + sizes(a, b));
  return std::isfinite(gap) ? gap : -kInfinity;
}

double lower_along(const Vec3& normal, double kept_gap, const PlacedPart& a,
                   const PlacedPart& b) noexcept {
  const double turned = swept_by(a) + swept_by(b);
  const double middles = normal.dot(b.ball_in_world.centre - a.ball_in_world.centre);
  return kept_gap + middles - turned - kError * (std::abs(kept_gap) + turned + sizes(a, b));
}

}  // namespace clearance
