// Bounds of the rounding error in one query, in metres. Every other bound is widened by them.
//
// One ulp here is 2^-53, the largest relative error of one rounding. The counts are upper bounds.
// Their derivation is in core/README.md, "Why the bounds hold in floating point", and
// core/ROUNDING.md.
#pragma once

#include <algorithm>
#include <cassert>

#include "core/convex_body.hpp"
#include "core/numerics/error_constants.hpp"
#include "core/pose.hpp"

namespace clearance {

struct Precision {
  double size;  // m: extent_a + extent_b + |translation|, the unit of the ulps
  // m: no bound computed in doubles from this model is off by more, up or down.
  double error_bound;
  // m: doubles cannot bring the upper bound closer to the lower one than this (before error_bound).
  double gap_tolerance;
  double extent_a, extent_b;  // m: the closest points lie within these of their frames' origins
  double promised;            // m: the bounds of a converged answer differ by no more

  // Are bounds with this gap, error_bound included, as near to each other as a converged answer's?
  [[nodiscard]] bool converged(double gap) const noexcept {
    return gap <= std::max(gap_tolerance + 2.0 * error_bound, promised);
  }
  // The same for bodies that touch within rounding. A penetration by less than the error bound can
  // be seen from one side only: thrice.
  [[nodiscard]] bool is_contact(double gap) const noexcept {
    return gap <= 3.0 * error_bound + 5.0 * gap_tolerance;
  }
};

// The errors of B's pose in A's frame, and its distance (m).
struct PlacePrecision {
  double rotation_error, translation_error;  // as in RelativePose
  double translation;                        // |translation|
};

// `farthest`: an upper bound of the distance or penetration depth (m). It limits the part of an
// unbounded body in which the closest points can lie.
//
// A wrong rotation moves a point of B by at most its error times extent_b. Alternatively, B is
// fixed and the wrong rotation rotates A about B's origin. No point of A is farther from there than
// extent_a plus the translation. The part of the error that is not a rotation then stretches the
// distance. Both are bounds, so the smaller one counts.
//
// It is always inlined: a call from vector code would change between instruction sets, which takes
// as long as a third of a query.
[[nodiscard, gnu::always_inline]] inline Precision precision(const ConvexBody& a,
                                                             const ConvexBody& b,
                                                             const PlacePrecision& b_in_a,
                                                             double farthest) noexcept {
  assert(!(farthest < 0.0) && !(b_in_a.translation < 0.0));
  const bool a_bounded = a.bounded(), b_bounded = b.bounded();
  Precision p;
  const double translation = b_in_a.translation;
  double ulps = kGapToleranceUlps[0], on_features = a.error_bound_as_a + b.error_bound_as_b;
  p.extent_a = a.bounding_radius;
  p.extent_b = b.bounding_radius;
  if (!a_bounded) {
    p.extent_a = std::max(p.extent_a, b.bounding_radius + translation + farthest);
    on_features += kUlp * kUlpsOnA * p.extent_a;
  }
  if (!b_bounded) {
    p.extent_b = std::max(p.extent_b, a.bounding_radius + translation + farthest);
    on_features += kUlp * kUlpsOnB * p.extent_b;
  }
  if (!a_bounded || !b_bounded) ulps = kGapToleranceUlps[!a_bounded + !b_bounded];
  p.size = p.extent_a + p.extent_b + translation;
  const double rotated =
      a_bounded ? std::min(p.extent_b, p.extent_a + translation + kStretched * farthest)
                : p.extent_b;
  p.error_bound = on_features + (kUlp * kUlpsBetween * translation + b_in_a.translation_error) +
                  b_in_a.rotation_error * rotated;
  p.gap_tolerance = ulps * kUlp * p.size;
  p.promised = (a_bounded || b_bounded ? kConvergedGap : kContactGap) * p.size;
  return p;
}

[[nodiscard]] inline Precision precision(const ConvexBody& a, const ConvexBody& b,
                                         const RelativePose& a_from_b, double farthest) noexcept {
  return precision(
      a, b, {a_from_b.rotation_error, a_from_b.translation_error, a_from_b.translation.norm()},
      farthest);
}

}  // namespace clearance
