// How far a body reaches in a direction, as a bound that holds (the support function h(m) = max
// m.x).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/convex_body.hpp"

namespace clearance {

struct Support {
  double reach =
      0.0;  // max over the anchors of m.x as computed: off by at most 3 roundings of |m||x|
  std::int32_t anchor = 0;  // where it is attained
};

// Exact up to the rounding of the products: bodies of many vertices are climbed along their edges
// from where the start table says, and no vertex is left out that could be higher (see
// support_function.cpp); others are scanned. m: unit up to rounding, the body's frame.
[[nodiscard]] Support support(const ConvexBody& body, const Vec3& m) noexcept;

// Over all anchors, without the edge graph.
[[nodiscard]] Support support_by_scan(const ConvexBody& body, const Vec3& m) noexcept;

// For an unbounded body: how much farther than its anchors it reaches along m, at most, at points
// whose distance from the frame's origin is at most `within` (m). Rounding included. 0 for a
// bounded body.
[[nodiscard]] double reach_along_rays(const ConvexBody& body, const Vec3& m,
                                      double within) noexcept;

inline constexpr std::size_t kLookedUpTogether = 16;

// For up to kLookedUpTogether facets of `body`, a vertex of `other` that is deepest below each or
// nearly so: vertices[facet]. `turn` leads from body's frame to other's. `other`: bounded, with
// edges.
void look_up_farthest(const ConvexBody& body, const ConvexBody& other, const Mat3& turn,
                      std::span<const std::uint16_t> facets, std::uint16_t* vertices) noexcept;

}  // namespace clearance
