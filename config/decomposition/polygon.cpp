#include "config/decomposition/polygon.hpp"

#include <cmath>
#include <utility>

namespace clearance {

// I. Sutherland and G. Hodgman, "Reentrant polygon clipping", 1974, for both sides at once.
CutPolygon cut_by(const Polygon& polygon, const HalfSpace& plane, double slack) {
  std::vector<double> heights;
  heights.reserve(polygon.size());
  bool is_above = false, is_below = false;
  for (const Vec3& vertex : polygon) {
    const double height = plane.normal.dot(vertex) - plane.offset;
    heights.push_back(std::abs(height) <= slack ? 0.0 : height);
    is_above |= heights.back() > 0.0;
    is_below |= heights.back() < 0.0;
  }
  if (!is_above) return {polygon, {}};
  if (!is_below) return {{}, polygon};
  CutPolygon cut;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t next = (i + 1) % polygon.size();
    if (heights[i] <= 0.0) cut.inside.push_back(polygon[i]);
    if (heights[i] >= 0.0) cut.outside.push_back(polygon[i]);
    if (heights[i] * heights[next] >= 0.0) continue;
    const double share = heights[i] / (heights[i] - heights[next]);
    Vec3 crossing = polygon[i] + share * (polygon[next] - polygon[i]);
    // A plane across an axis is met without rounding.
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (std::abs(plane.normal[axis]) == 1.0) crossing[axis] = plane.offset * plane.normal[axis];
    }
    cut.inside.push_back(crossing);
    cut.outside.push_back(crossing);
  }
  return cut;
}

bool subtract(const Polygon& polygon, std::span<const HalfSpace> planes,
              std::vector<Polygon>& rest) {
  const std::size_t before = rest.size();
  Polygon inside = polygon;
  for (const HalfSpace& plane : planes) {
    CutPolygon cut = cut_by(inside, plane);
    inside = std::move(cut.inside);
    if (inside.size() < 3) {
      rest.resize(before);
      rest.push_back(polygon);
      return false;
    }
    if (cut.outside.size() >= 3) rest.push_back(std::move(cut.outside));
  }
  return true;
}

double area_of(const Polygon& polygon) {
  Vec3 twice = Vec3::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  }
  return 0.5 * twice.norm();
}

}  // namespace clearance
