// The smallest circle around points of a plane (E. Welzl, "Smallest enclosing disks (balls and
// ellipsoids)", 1991), and the same for balls, in doubles: nothing is certified here.
#pragma once

#include <span>
#include <vector>

#include "core/vec.hpp"

namespace clearance {

struct Circle {
  Vec2 centre = Vec2::Zero();
  double radius = 0.0;  // m
};

// `points`: at least one.
[[nodiscard]] Circle enclosing_circle(std::span<const Vec2> points);

// The vertices of the hull, counter-clockwise (A. M. Andrew's monotone chain, 1979).
[[nodiscard]] std::vector<Vec2> convex_polygon(std::vector<Vec2> points);

}  // namespace clearance
