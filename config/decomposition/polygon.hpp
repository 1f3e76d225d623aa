// Convex polygons in space, cut by planes.
#pragma once

#include <span>
#include <vector>

#include "core/shapes.hpp"

namespace clearance {

using Polygon = std::vector<Vec3>;  // vertices in order around it; fewer than three: empty

struct CutPolygon {
  Polygon inside, outside;  // n.x <= d, and n.x >= d
};

// Vertices within `slack` of the plane count as on it: they belong to both sides, and are not
// moved.
[[nodiscard]] CutPolygon cut_by(const Polygon& polygon, const HalfSpace& plane, double slack = 0.0);

// Adds to `rest` convex polygons that cover `polygon` less the intersection of the half-spaces. A
// polygon that does not meet the intersection stays whole. Each new vertex is exact up to rounding.
// Returns true when something was taken away.
bool subtract(const Polygon& polygon, std::span<const HalfSpace> planes,
              std::vector<Polygon>& rest);

[[nodiscard]] double area_of(const Polygon& polygon);

}  // namespace clearance
