// The corner of one body that is deepest below a facet of another, for many facets in a row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/convex_polyhedron.hpp"

namespace clearance {

inline constexpr std::size_t kLookedUpTogether = 16;

// For some facets of `body`, no more than that, which corner of `other` reaches farthest against
// their normals, if not for certain: corners[facet]. `turn` leads from body's frame to other's.
// `other`: bounded, with edges.
void look_up_farthest(const ConvexPolyhedron& body, const ConvexPolyhedron& other, const Mat3& turn,
                      std::span<const std::uint16_t> facets, std::uint16_t* corners) noexcept;

}  // namespace clearance
