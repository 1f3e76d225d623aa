// The penetration depth of two bodies: the length of the shortest translation that separates them,
// certified.
//
// Let h(n) be the displacement of B along the unit direction n after which it only touches A. It is
// the sum of the support values of A along n and of B along -n. The depth is the smallest h(n), and
// every n bounds it from above. h is not convex on the sphere and has many local minima. Each of
// them lies at a facet normal of A or B, or at a crossing of two edge arcs on the Gauss map. The
// arc of an edge joins the normals of its two facets. So it is enough to know h at all facet
// normals and along the edge arcs of one of the bodies. Within a region between such arcs one
// vertex of that body is the support point. There h is the support value of the other body moved by
// that vertex. It is smallest at a facet of the other body or on the region's boundary. The same
// argument, with h <= 0, says that a positive bound there certifies that the bodies penetrate each
// other.
//
// The bound from below needs no combinatorics that rounding could upset. A point c of the Minkowski
// difference gives h(n) >= c.n everywhere. On the arc between l and r, h is at least the smaller
// one of c.l and c.r. One such c, kept from elsewhere, bounds most arcs and facets against the
// best h known. Any other arc is split where two such bounds cross, until the support point there
// shows nothing higher. The splitting ends because each split finds a new vertex. Nothing has to be
// stored from one arc to the next.
#pragma once

#include "core/active_set/active_feature.hpp"
#include "core/active_set/certificate.hpp"

namespace clearance {

struct Depth {
  // m, rounding included. lower > 0: the bodies penetrate, and no shorter translation separates
  // them. lower < 0: they penetrate, or their distance is at most -lower. upper: B, moved by this
  // along `normal`, is clear of A. upper < 0: their distance is at least -upper. The search then
  // ends without a lower bound. Nothing is known of two unbounded bodies.
  double lower = -kInfinity, upper = kInfinity;
  double value = kInfinity;    // m: best estimate
  Vec3 normal = Vec3::Zero();  // unit, frame A, from A towards B
  // The facet of A or of B whose normal that is, if it is one.
  std::int32_t facet_of_a = kNone, facet_of_b = kNone;
};

// `guess`: a direction to begin with; it costs or saves time and changes nothing else.
[[nodiscard]] Depth depth(const ActiveFeature& a, const ActiveFeature& b,
                          const RelativePose& a_from_b, const Separator& guess) noexcept;

}  // namespace clearance
