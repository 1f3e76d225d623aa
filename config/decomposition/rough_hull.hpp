// The planes of the convex hull of a few hundred points, quickly and roughly.
//
// In plain doubles, of points that are moved by a ten thousandth of their extent. For comparing
// cuts and mergers only; what a cell gets is made by core/shapes.hpp and exact.
#pragma once

#include <span>
#include <vector>

#include "core/shapes.hpp"

namespace clearance {

// Unit normals. Empty: of fewer than four points, or where all are one.
[[nodiscard]] std::vector<HalfSpace> rough_hull(std::span<const Vec3> points);

[[nodiscard]] inline bool holds(std::span<const HalfSpace> planes, const Vec3& point,
                                double slack = 0.0) {
  for (const HalfSpace& plane : planes) {
    if (plane.normal.dot(point) > plane.offset + slack) return false;
  }
  return true;
}

}  // namespace clearance
