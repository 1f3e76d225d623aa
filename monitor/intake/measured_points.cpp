#include "monitor/intake/measured_points.hpp"

#include <cmath>
#include <cstring>
#include <limits>

namespace clearance {
namespace {

constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();
constexpr float kTooNear = -std::numeric_limits<float>::infinity();

float float_at(const std::byte* bytes) noexcept {
  float value = 0.0F;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

// The true point lies within the error along the ray of the measured one, and its neighbours within
// half of the spacing across it.
MeasuredPoint ball(float x, float y, float z, const Sensor& sensor, bool& is_wide) noexcept {
  const double range = std::sqrt(double{x} * x + double{y} * y + double{z} * z);
  const double depth = sensor.along_ray ? range : double{z};
  is_wide = is_wide ||
            (std::isfinite(range) && range >= sensor.least_depth && range > kLongestRay * depth);
  const bool is_there = depth >= sensor.least_depth && depth <= sensor.greatest_depth;
  if (!is_there && sensor.by_neighbours) return {x, y, z, kMissing};
  if (!is_there) return {kMissing, kMissing, kMissing, 0.0F};
  const double error = sensor.error_at(depth);
  const double radius = error * (range / depth) + (depth + error) * sensor.spacing * kHalfDiagonal;
  return {x, y, z,
          std::nextafter(static_cast<float>(radius * (1.0 + 0x1p-40)),
                         std::numeric_limits<float>::infinity())};
}

}  // namespace

FrameFault measured_points(const PointsView& view, const Sensor& sensor,
                           std::vector<MeasuredPoint>& points) {
  points.clear();
  bool is_wide = false;
  for (std::uint32_t row = 0; row < view.height; ++row) {
    const std::byte* point = view.bytes.data() + row * view.row_step;
    for (std::uint32_t column = 0; column < view.width; ++column, point += view.point_step) {
      const float x = float_at(point + view.x), y = float_at(point + view.y),
                  z = float_at(point + view.z);
      if (x == kTooNear || y == kTooNear || z == kTooNear) return FrameFault::kTooNear;
      points.push_back(ball(x, y, z, sensor, is_wide));
    }
  }
  return is_wide ? FrameFault::kCannotBuild : FrameFault::kNoFault;
}

}  // namespace clearance
