// What rounding can do to one query, as lengths. Derived once, so that every bound can be widened
// by it.
//
// One ulp here is 2^-53, the largest relative error of one rounding. The counts are upper bounds;
// the derivation is in core/README.md, "Why the bounds hold in floating point", and
// core/ROUNDING.md.
#pragma once

#include <algorithm>

#include "core/convex_body.hpp"
#include "core/numerics/error_constants.hpp"
#include "core/pose.hpp"

namespace clearance {

struct Precision {
  double size;  // m: reach_a + reach_b + |translation|: what ulps are counted in
  // m: no bound computed in doubles from this model is off by more, either way.
  double error_bound;
  // m: an upper bound this close to the lower one (before error_bound) is as good as it gets.
  double gap_tolerance;
  double reach_a, reach_b;  // m: the closest points lie within these of their frames' origins
  double promised;          // m: as near to each other are bounds that have converged

  // Are bounds, error_bound included, this near to each other what a converged answer promises?
  [[nodiscard]] bool converged(double gap) const noexcept {
    return gap <= std::max(gap_tolerance + 2.0 * error_bound, promised);
  }
};

// How well B's place as seen from A is known, and how far away it is (m).
struct PlacePrecision {
  double rotation_error, translation_error;  // as in RelativePose
  double apart;                              // |translation|
};

// `farthest`: an upper bound of the distance or penetration depth (m), which limits where on an
// unbounded body the closest points can lie.
//
// A wrong rotation moves a point of B by its error times reach_b. Or else B may be thought of as
// fixed: the wrong rotation then turns A about B's origin, from where A reaches no farther than
// reach_a + apart, and what it is short of a rotation stretches the distance. Both are bounds, so
// the smaller one counts.
[[nodiscard]] inline Precision precision(const ConvexBody& a, const ConvexBody& b,
                                         const PlacePrecision& b_in_a, double farthest) noexcept {
  Precision p;
  const double apart = b_in_a.apart;
  double ulps = kGapToleranceUlps[0], on_features = a.error_bound_as_a + b.error_bound_as_b;
  p.reach_a = a.bounding_radius;
  p.reach_b = b.bounding_radius;
  if (!a.bounded()) {
    p.reach_a = std::max(p.reach_a, b.bounding_radius + apart + farthest);
    on_features += kUlp * kUlpsOnA * p.reach_a;
  }
  if (!b.bounded()) {
    p.reach_b = std::max(p.reach_b, a.bounding_radius + apart + farthest);
    on_features += kUlp * kUlpsOnB * p.reach_b;
  }
  if (!a.bounded() || !b.bounded()) ulps = kGapToleranceUlps[!a.bounded() + !b.bounded()];
  p.size = p.reach_a + p.reach_b + apart;
  const double turned =
      a.bounded() ? std::min(p.reach_b, p.reach_a + apart + kStretched * farthest) : p.reach_b;
  p.error_bound = on_features + (kUlp * kUlpsBetween * apart + b_in_a.translation_error) +
                  b_in_a.rotation_error * turned;
  p.gap_tolerance = ulps * kUlp * p.size;
  p.promised = (a.bounded() || b.bounded() ? kConvergedGap : kContactGap) * p.size;
  return p;
}

[[nodiscard]] inline Precision precision(const ConvexBody& a, const ConvexBody& b,
                                         const RelativePose& a_from_b, double farthest) noexcept {
  return precision(
      a, b, {a_from_b.rotation_error, a_from_b.translation_error, a_from_b.translation.norm()},
      farthest);
}

}  // namespace clearance
