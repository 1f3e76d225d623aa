// The extent of a curved shape, and sample points that represent it. Both are in the local frame
// and leave out the radius around the shape.
#pragma once

#include <vector>

#include "core/curved_shape.hpp"

namespace clearance {

// The support function: the greatest m.x over the points of the shape. It is within a few roundings
// of |m| times their distance from the origin. m need not be unit.
[[nodiscard]] double support_value(const CurvedShape& shape, const Vec3& m) noexcept;

// The greatest distance of a point of the shape from `position`, m, within a few roundings. It is
// exact for truncated cones and from an ellipsoid's centre, and otherwise an upper bound.
[[nodiscard]] double farthest_from(const CurvedShape& shape, const Vec3& position) noexcept;

// The centre of a small sphere around the shape.
[[nodiscard]] Vec3 middle(const CurvedShape& shape) noexcept;

// Points on the whole surface: `round` on each circle.
[[nodiscard]] std::vector<Vec3> surface_points(const CurvedShape& shape, int round);

}  // namespace clearance
