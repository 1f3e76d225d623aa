// Finds where a ray from the origin first meets a body of a simple form: closed forms, in doubles.
//
// The ray is t * direction for t >= 0. Its direction need not be of unit length, so that a pixel's
// direction (x, y, 1) gives t as a depth. Each function returns the least t at which the ray is in
// the closed body: 0 if the origin is, infinity if the ray misses. Lengths are in m.
#pragma once

#include "core/curved_shape.hpp"
#include "core/vec.hpp"

namespace clearance::rendering {

[[nodiscard]] double hit_sphere(const Vec3& centre, double radius, const Vec3& direction) noexcept;
// All points within `radius` of the segment.
[[nodiscard]] double hit_capsule(const Vec3& start, const Vec3& end, double radius,
                                 const Vec3& direction) noexcept;
// The body is in a frame of its own, in which the ray begins at `origin`. A truncated cone may be a
// cylinder or a cone.
[[nodiscard]] double hit_truncated_cone(const CurvedShape& cone, const Vec3& origin,
                                        const Vec3& direction) noexcept;
[[nodiscard]] double hit_ellipsoid(const CurvedShape& ellipsoid, const Vec3& origin,
                                   const Vec3& direction) noexcept;

}  // namespace clearance::rendering
