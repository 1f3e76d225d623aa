#include "config/decomposition/plate.hpp"

#include <algorithm>
#include <cmath>

namespace clearance {
namespace {

// Relative to the size: points so near to a plane lie in it, up to single precision.
constexpr double kInOnePlane = 1e-6;

}  // namespace

std::optional<Vec3> plane_of(const std::vector<Vec3>& points, double plate) {
  if (points.size() < 3) return std::nullopt;
  const auto farthest = [&](const auto& distance) {
    return *std::ranges::max_element(points, {}, distance);
  };
  const Vec3 a = points[0];
  const Vec3 b = farthest([&](const Vec3& v) { return (v - a).squaredNorm(); });
  const double size = (b - a).norm();
  const Vec3 c = farthest([&](const Vec3& v) { return (b - a).cross(v - a).squaredNorm(); });
  const Vec3 across = (b - a).cross(c - a);
  if (!(across.norm() > kInOnePlane * size * size)) return std::nullopt;
  const Vec3 normal = across.normalized();
  const double most = std::min(kInOnePlane * size, 0.5 * plate);
  const bool flat = std::ranges::all_of(
      points, [&](const Vec3& v) { return std::abs(normal.dot(v - a)) <= most; });
  return flat ? std::optional(normal) : std::nullopt;
}

std::vector<Vec3> with_volume(const std::vector<Vec3>& points, double plate) {
  const auto normal = plane_of(points, plate);
  if (!normal) return points;
  std::vector<Vec3> sides;
  for (const double side : {-0.5, 0.5})
    for (const Vec3& point : points) sides.push_back(point + side * plate * *normal);
  return sides;
}

}  // namespace clearance
