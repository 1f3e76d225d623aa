#include "monitor/bodies/swept_bound.hpp"

#include <algorithm>
#include <cmath>

#include "core/convex_body.hpp"
#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

// Error of the difference of two unit directions, each rotated into the world by a rounded pose.
// The error of each is below 200 ulps (2^-53).
constexpr double kSwungError = 0x1p-44;

}  // namespace

// After a displacement x the distance is at least `before` - x. It is also at least `now` less the
// rest of `displacement`. The first bound favours a small x, the second a large one; they meet at
// `halfway`.
double lower_by_ends(double before, double now, double displacement) noexcept {
  if (!(displacement < kInfinity)) return now < kInfinity ? -kInfinity : now;
  const double halfway = 0.5 * (before + now - displacement);
  const double lower = std::max({halfway, before - displacement, now - displacement});
  return std::min(now, rounded_down(lower - (std::abs(now) + displacement) * 0x1p-50));
}

double lower_by_directions(const Separated& before, const Separated& now, double displacement,
                           double bend) noexcept {
  // The sum of absolute values is an upper bound of the norm without a root.
  const double swung = std::abs(now.normal.x() - before.normal.x()) +
                       std::abs(now.normal.y() - before.normal.y()) +
                       std::abs(now.normal.z() - before.normal.z()) + kSwungError;
  const double least = std::min(before.lower, now.lower);
  const double sag = swung * displacement;
  const double below = 0.25 * std::max(0.0, sag - std::abs(now.lower - before.lower)) + bend;
  const double lower = least - below - (std::abs(least) + sag + bend) * 0x1p-50;
  return lower >= 0.0 ? lower : -kInfinity;  // the mean direction may be shorter than 1
}

}  // namespace clearance
