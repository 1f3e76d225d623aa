// What rounding can do to one query, as lengths. Derived once, so that every bound can be widened
// by it.
//
// One ulp here is 2^-53, the largest relative error of one rounding. The counts are upper bounds;
// the derivation is in core/README.md, "Why the bounds hold in floating point".
#pragma once

#include "core/convex_polyhedron.hpp"
#include "core/pose.hpp"

namespace clearance {

struct Precision {
  double size;   // m: reach of A + reach of B + |translation|: what ulps are counted in
  double slack;  // m: no bound computed in doubles from this model is off by more, either way
  double
      tight;  // m: an upper bound this close to the lower one (before slack) is as good as it gets
  double reach_a, reach_b;  // m: the closest points lie within these of their frames' origins
};

// `farthest`: an upper bound of the distance (m), which limits where on an unbounded body to look.
[[nodiscard]] Precision precision(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                  const RelativePose& a_from_b, double farthest) noexcept;

}  // namespace clearance
