// The rounding error of the bounds of a curved pair, and the step from bounds of the bodies without
// their radii to the answer.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/curved/body_view.hpp"
#include "core/model/error_bounds.hpp"
#include "core/model/finish.hpp"

namespace clearance {

// Roundings of the support values, the support points and the results made from them. They are
// counted in ulps of A's bounding radius, of B's and of the translation's length. The test
// tests/core/curved/rounding_count_test.cpp counts them one by one. A support point has 2 for the
// products with the semi-axes, 2.5 for a norm and 1 for a quotient. It has as many again when it is
// pulled inside. B also has 4 to rotate the direction into B's frame and 4 to rotate the point
// back. Both have 2 to place the point and subtract, 3 for the product with n, and 2.5 for n's
// length.
inline constexpr double kUlpsOfA = 18, kUlpsOfB = 26, kUlpsOfOffset = 12;

// Neither bound is off by more than this, m. `upper`: the upper bound, if there is one. `size`:
// that of the pair.
[[nodiscard]] inline double rounding_error(const BodyView& a, const BodyView& b,
                                           const PlacePrecision& at, double upper,
                                           double size) noexcept {
  const double farthest = std::max(0.0, std::min(upper, size));
  const double rotated =
      std::min(b.bounding_radius, a.bounding_radius + at.translation + kStretched * farthest) *
      kRoundedUp;
  const double ulps =
      kUlpsOfA * a.bounding_radius + kUlpsOfB * b.bounding_radius + kUlpsOfOffset * at.translation;
  return kUlp * ulps + a.body->position_error + b.body->position_error + at.translation_error +
         at.rotation_error * rotated + kUnderflow;
}

struct CurvedConclusion {
  double lower = -kInfinity, upper = kInfinity;  // signed, as computed
  double error = 0.0;                            // m: neither bound is off by more
  double size = 0.0;                             // m: bounding radii and translation length
  Vec3 normal = Vec3::Zero();                    // unit, from A to B; this and the points: frame A
  Vec3 point_on_a = Vec3::Zero(), point_on_b = Vec3::Zero();  // on the bodies without radii
  bool is_radial = false;  // the normal is that of a closed form, along the gap vector to rounding
};

// The direction, from A to B, in which radii are added; `sum`: of both radii, m. If the bodies with
// their radii are disjoint, it is the direction of the gap vector. Then the rest of that vector is
// as long as the distance. The direction of a shorter vector may be that of its rounding.
[[nodiscard]] inline Vec3 radial_direction(const CurvedConclusion& found, double sum) noexcept {
  if (found.is_radial || !(found.lower > sum)) return found.normal;
  return unit_along(Vec3(found.point_on_b - found.point_on_a));
}

// Bounds that have converged are within kConvergedCurvedGap of each other, times the pair's size.
// The error of the place may be larger. Then they were within kComputedGap before any error was
// added. The difference is twice the largest error that roundings of a pair and of its place make.
inline constexpr double kConvergedCurvedGap = 1e-13;
inline constexpr double kComputedGap =
    kConvergedCurvedGap - 2.0 * (kUlpsOfB * kUlp + kRotationError);

// The result of the bodies with their radii.
[[nodiscard]] inline DistanceResult conclude(const ConvexBody& a, const ConvexBody& b,
                                             const CurvedConclusion& found) noexcept {
  // A difference of a bound and the error is off by at most 2 ulps of the bound.
  const auto rounding = [](double bound) { return 0x1p-51 * std::abs(bound); };
  // Points give the best estimate of a distance, and directions that of a depth.
  const double best = found.lower < 0.0 ? found.lower : found.upper;
  Answer r;
  r.lower = found.lower - found.error - rounding(found.lower);
  r.upper = found.upper + found.error + rounding(found.upper);
  r.distance = std::clamp(best, r.lower, r.upper);
  r.normal = found.normal;
  r.point_on_a = found.point_on_a;
  r.point_on_b = found.point_on_b;
  r.path = DistancePath::kDirection;
  if (found.upper - found.lower <= kComputedGap * found.size ||
      r.upper - r.lower <= kConvergedCurvedGap * (found.size + radii(a, b))) {
    r.status = DistanceStatus::kConverged;
  }
  const double sum = radii(a, b);
  finish(a, b, sum > 0.0 ? radial_direction(found, sum) : found.normal, r);
  return r;
}

}  // namespace clearance
