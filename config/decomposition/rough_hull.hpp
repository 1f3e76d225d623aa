// Finds the planes of the convex hull of a few hundred points, quickly and roughly.
//
// It computes in plain doubles, with points moved by a ten thousandth of their extent. It only
// compares cuts and mergers: the parts of a cell are made by core/shapes.hpp, exactly.
#pragma once

#include <span>
#include <vector>

#include "core/shapes.hpp"

namespace clearance {

// Returns planes with unit normals. There are none if the points are fewer than four, or all the
// same.
[[nodiscard]] std::vector<HalfSpace> rough_hull(std::span<const Vec3> points);

[[nodiscard]] inline bool holds(std::span<const HalfSpace> planes, const Vec3& point,
                                double slack = 0.0) {
  for (const HalfSpace& plane : planes) {
    if (plane.normal.dot(point) > plane.offset + slack) return false;
  }
  return true;
}

}  // namespace clearance
