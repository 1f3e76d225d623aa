// How far a curved shape reaches, and points that stand for it. Without the radius around it, in
// its own frame.
#pragma once

#include <vector>

#include "core/curved_shape.hpp"

namespace clearance {

// The support function: the greatest m.x of its points; within a few roundings of |m| times their
// distance from the origin. m need not be unit.
[[nodiscard]] double support_value(const CurvedShape& shape, const Vec3& m) noexcept;

// No point is farther from `position` than this, m; within a few roundings. Of truncated cones, and
// from an ellipsoid's centre, one is as far.
[[nodiscard]] double farthest_from(const CurvedShape& shape, const Vec3& position) noexcept;

// The middle of a small sphere around it.
[[nodiscard]] Vec3 middle(const CurvedShape& shape) noexcept;

// Points of its surface, all around: `round` of each circle.
[[nodiscard]] std::vector<Vec3> surface_points(const CurvedShape& shape, int round);

}  // namespace clearance
