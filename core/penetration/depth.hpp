// The penetration depth of two bodies: the length of the shortest translation that parts them,
// certified.
//
// Let h(n) be how far B must go along the unit direction n until it only touches A: the sum of the
// support values of A along n and of B along -n. The depth is the smallest h(n). Every n bounds it
// from above. h is not convex on the sphere and has many local minima, but each lies where a facet
// of A, a facet of B, or an edge of each faces along n: where the arcs cross that edges draw
// between the normals of their facets. So it is enough to know h at all facet normals and along the
// arcs of one of the bodies' edges: within a region between such arcs one vertex of that body is
// the support point, h is that of the other body moved there, and is smallest at a facet of it or
// on the region's boundary. The same argument, with h <= 0, says that a positive bound there
// certifies that the bodies penetrate each other.
//
// The bound from below needs no combinatorics that rounding could upset. A point c of the
// Minkowski difference gives h(n) >= c.n everywhere, and on the arc between l and r at least the
// smaller one of c.l and c.r. One such c, kept from elsewhere, settles most arcs and facets against
// the best h known; where it does not, the arc is split where two such bounds cross, until the
// support there shows nothing higher. That ends because each split finds a new vertex, and nothing
// has to be stored from one arc to the next.
#pragma once

#include "core/active_set/active_feature.hpp"
#include "core/active_set/certificate.hpp"

namespace clearance {

struct Depth {
  // m, rounding included. lower > 0: the bodies penetrate, and no translation shorter than this
  // parts them; negative: they penetrate or are no farther apart than this. upper: B moved by this
  // along `normal` is clear of A; negative: they are this far apart as they are (the search ends
  // there, and knows no lower). Of two unbounded bodies nothing is known.
  double lower = -kInfinity, upper = kInfinity;
  double value = kInfinity;    // m: best estimate
  Vec3 normal = Vec3::Zero();  // unit, common frame, from A towards B
};

// `guess`: a direction to begin with, or null; it costs or saves time and changes nothing else.
[[nodiscard]] Depth depth(const ActiveFeature& a, const ActiveFeature& b,
                          const RelativePose& a_from_b, const Separator* guess) noexcept;

}  // namespace clearance
