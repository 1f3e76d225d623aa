// How far a body reaches in a direction, as a bound that holds (the support function h(m) = max
// m.x).
#pragma once

#include <cstdint>

#include "core/convex_polyhedron.hpp"

namespace clearance {

struct Support {
  double reach =
      0.0;  // max over the anchors of m.x as computed: off by at most 3 roundings of |m||x|
  std::int32_t anchor = 0;  // where it is attained
};

// Exact up to the rounding of the products: bodies of many vertices are climbed along their edges
// from `start` and no vertex is left out that could be higher (see support.cpp); others are
// scanned. m: unit up to rounding, the body's frame. start: any anchor index.
[[nodiscard]] Support support(const ConvexPolyhedron& body, const Vec3& m,
                              std::int32_t start) noexcept;

// Over all anchors, without the edge graph.
[[nodiscard]] Support support_by_scan(const ConvexPolyhedron& body, const Vec3& m) noexcept;

// For an unbounded body: how much farther than its anchors it reaches along m, at most, at points
// whose distance from the frame's origin is at most `within` (m). Rounding included. 0 for a
// bounded body.
[[nodiscard]] double reach_along_rays(const ConvexPolyhedron& body, const Vec3& m,
                                      double within) noexcept;

// Whether the unbounded body certainly does not reach beyond its anchors along any direction within
// `uncertainty` of m: every ray falls away by more than that and rounding. An uncertainty of 0
// means exactly the direction of these three doubles; then exact rays may also stand exactly across
// it.
[[nodiscard]] bool rays_stay_below(const ConvexPolyhedron& body, const Vec3& m,
                                   double uncertainty) noexcept;

}  // namespace clearance
