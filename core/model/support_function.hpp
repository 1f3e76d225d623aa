// The support function of a body, h(m) = max m.x, as a bound that holds in doubles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/convex_body.hpp"

namespace clearance {

struct Support {
  // The maximum over the anchors of m.x as computed, off by at most 3 roundings of |m||x|.
  double value = 0.0;
  std::int32_t anchor = 0;  // the anchor at which it is attained
};

// Exact up to the rounding of the products. On bodies of many vertices it climbs along edges from
// the vertex that the start table names. It omits no vertex that could have a greater m.x
// (support_function.cpp). Other bodies are scanned. m: unit up to rounding, in the body's frame.
[[nodiscard]] Support support(const ConvexBody& body, const Vec3& m) noexcept;

// Over all anchors, without the edge graph.
[[nodiscard]] Support support_by_scan(const ConvexBody& body, const Vec3& m) noexcept;

// The excess that the support value of an unbounded body along m may have over that of its
// `anchors`. Only points within `within` (m) of the frame's origin count. Rounding included. 0 for
// a bounded body.
[[nodiscard]] double support_along_rays(const ConvexBody& body, const Vec3& m,
                                        double within) noexcept;

inline constexpr std::size_t kLookedUpTogether = 16;

// For each of up to kLookedUpTogether facets of `body`, sets vertices[facet]: a vertex of `other`
// that is deepest below the facet, or nearly so. `rotation` leads from body's frame to other's.
// `other`: bounded, with edges.
void look_up_support_points(const ConvexBody& body, const ConvexBody& other, const Mat3& rotation,
                            std::span<const std::uint16_t> facets,
                            std::uint16_t* vertices) noexcept;

}  // namespace clearance
