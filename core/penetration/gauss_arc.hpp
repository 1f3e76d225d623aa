// Bounds from below along the arc between the normals l and r of two facets that share an edge.
//
// On the arc n = ((1 - s) l + s r) / N with 0 <= s <= 1 and N <= 1. A point c of the Minkowski
// difference gives h(n) >= c.n. If positive, c.n is at least (1 - s) c.l + s c.r. Between two
// directions of the arc it is at least the lesser of the two values there. So every s at which one
// point takes over from the other, however rounded, gives a valid bound.
#pragma once

#include <algorithm>

#include "core/convex_body.hpp"

namespace clearance {

// The heights of one point at the two ends, m.
struct OnArc {
  double l, r;
  [[nodiscard]] double at(double s) const noexcept { return l + s * (r - l); }
  [[nodiscard]] double least() const noexcept { return std::min(l, r); }
};

// Uses one point up to the place where their heights cross, and the other from there on; or one of
// them along the whole arc.
[[nodiscard]] inline double least_of_two(const OnArc& first, const OnArc& last) noexcept {
  const double alone = std::max(first.least(), last.least());
  const double lead = first.l - last.l, behind = last.r - first.r;
  if (!(lead > 0.0 && behind > 0.0)) return alone;
  const double s = lead / (lead + behind);
  return std::max(alone, std::min({first.l, first.at(s), last.at(s), last.r}));
}

// Returns a lower bound of h along the arc in three spans. From l, `first` gives the bound until
// its height falls to `enough`. Towards r, `last` does so from where its height reaches `enough`.
// In between, a sphere does so, whose centre has the heights `middle`. Inside the arc, the centre
// is higher than linear interpolation says: 1 / N >= 1 + s (1 - s) |l - r|^2 / 2. chord2: |l -
// r|^2.
[[nodiscard]] inline double least_with_sphere(const OnArc& first, const OnArc& middle,
                                              double radius, const OnArc& last, double chord2,
                                              double enough) noexcept {
  if (!(middle.least() >= 0.0)) return -kInfinity;
  const double from = first.l > enough ? (first.l - enough) / (first.l - first.r) : 0.0;
  const double to = last.r > enough ? (last.r - enough) / (last.r - last.l) : 0.0;
  if (!(from >= 0.0 && to >= 0.0 && from + to <= 1.0)) return -kInfinity;
  const auto sphere = [&](double s) {
    return middle.at(s) * (1.0 + 0.5 * s * (1.0 - s) * chord2) + radius;
  };
  return std::min(
      {first.l, first.at(from), sphere(from), sphere(1.0 - to), last.at(1.0 - to), last.r});
}

}  // namespace clearance
