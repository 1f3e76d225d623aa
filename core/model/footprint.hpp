// How much memory a body takes.
#pragma once

#include <cstddef>

#include "core/convex_polyhedron.hpp"

namespace clearance {

// Bytes, all of its tables included; what the allocator adds is not.
[[nodiscard]] std::size_t footprint(const ConvexPolyhedron& body) noexcept;

}  // namespace clearance
