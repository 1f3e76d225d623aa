#include "monitor/intake/measured_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "monitor/intake/layout.hpp"

namespace clearance {
namespace {

constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();
constexpr float kTooNear = -std::numeric_limits<float>::infinity();

// Times of the points of a frame, s. Integers are offsets in ns. Numbers of floating point are in
// s, unless they are so large that only ns since an epoch can be meant.
class Sweep {
 public:
  explicit Sweep(const PointsView& view) : view_(view) {}

  void add(const std::byte* point) noexcept {
    if (view_.times == PointsView::Times::kNotSent) return;
    const double time = time_at(point + view_.time);
    is_known_ = is_known_ && std::isfinite(time);
    first_ = std::min(first_, time);
    last_ = std::max(last_, time);
    if (view_.times == PointsView::Times::kFloat32)
      rounding_ = std::max(rounding_, 0x1p-23 * std::abs(time));
  }
  // Offsets count from the stamp; of times since an epoch, only their difference counts.
  [[nodiscard]] bool is_within(std::int64_t ns) const noexcept {
    if (!(first_ <= last_)) return is_known_;
    const bool is_offset = std::max(std::abs(first_), std::abs(last_)) < kLongestOffset;
    const double from = is_offset ? std::min(first_, 0.0) : first_;
    const double to = is_offset ? std::max(last_, 0.0) : last_;
    return is_known_ && 1e9 * (to - from + rounding_) <= static_cast<double>(ns);
  }

 private:
  static constexpr double kLongestOffset = 1e6;    // s
  static constexpr double kLeastEpochInNs = 1e17;  // three years

  [[nodiscard]] double time_at(const std::byte* at) const noexcept {
    if (view_.times == PointsView::Times::kUint32) return 1e-9 * number_at<std::uint32_t>(at);
    const double time = view_.times == PointsView::Times::kFloat32
                            ? static_cast<double>(number_at<float>(at))
                            : number_at<double>(at);
    return time > kLeastEpochInNs ? 1e-9 * time : time;
  }

  const PointsView& view_;
  double first_ = std::numeric_limits<double>::infinity();
  double last_ = -std::numeric_limits<double>::infinity();
  double rounding_ = 0.0;
  bool is_known_ = true;
};

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
  Sweep sweep(view);
  for (std::uint32_t row = 0; row < view.height; ++row) {
    const std::byte* point = view.bytes.data() + row * view.row_step;
    for (std::uint32_t column = 0; column < view.width; ++column, point += view.point_step) {
      const float x = number_at<float>(point + view.x), y = number_at<float>(point + view.y),
                  z = number_at<float>(point + view.z);
      if (x == kTooNear || y == kTooNear || z == kTooNear) return FrameFault::kTooNear;
      points.push_back(ball(x, y, z, sensor, is_wide));
      const MeasuredPoint& added = points.back();
      if (!std::isnan(added.x) && !std::isnan(added.radius)) sweep.add(point);
    }
  }
  if (!sweep.is_within(sensor.stamp_error_ns)) return FrameFault::kLongScan;
  return is_wide ? FrameFault::kCannotBuild : FrameFault::kNoFault;
}

}  // namespace clearance
