// sensor_msgs/LaserScan: the end of each ray as a ball, which reaches to the middle between it and
// the next ray.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "monitor/intake/digest.hpp"
#include "monitor/intake/measured_points.hpp"
#include "monitor/intake/message_cloud.hpp"
#include "monitor/intake/tf_tree.hpp"
#include "monitor/wire/camera_types.hpp"

namespace clearance {

class ScanCloud final : public MessageCloud {
 public:
  // Rays that are farther apart have gaps that no ball may span, rad.
  static constexpr double kWidestIncrement = 0.1;
  // The largest angle of a ray, rad: float32 does not tell much larger ones apart.
  static constexpr double kLargestAngle = 4.0 * std::numbers::pi;

  Sample<sensor_msgs_msg_dds__LaserScan_> sample;

  [[nodiscard]] bool read(const RawSensorMessage&, const Sensor& sensor) {
    stamp_ns = clearance::stamp_ns(sample->header);
    frame = frame_name(sample->header.frame_id);
    columns = sample->ranges._length;
    rows = 1;
    fault = judge(sensor);
    Digest digest;
    for (const float number :
         {sample->angle_min, sample->angle_max, sample->range_min, sample->range_max})
      digest.add(std::uint64_t{std::bit_cast<std::uint32_t>(number)});
    form = {digest_of_frame(frame), digest.value()};
    return true;
  }

  // As REP 117 says: +inf saw nothing, NaN is a fault of the measurement, and a number outside of
  // [range_min, range_max] counts as none. -inf is nearer than can be measured: its ball spans the
  // ray up to range_min.
  [[nodiscard]] FrameFault elements(const Sensor& sensor, std::vector<MeasuredPoint>& out,
                                    double& excess) const override {
    constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();
    out.clear();
    excess = 0.0;
    const double increment = sample->angle_increment;
    const double half_gap =
        std::max(std::tan(0.5 * std::abs(increment)), sensor.spacing * kHalfDiagonal);
    for (std::uint32_t i = 0; i < columns; ++i) {
      const double range = ranges()[i];
      const bool is_too_near = range == -std::numeric_limits<double>::infinity();
      const bool is_there = range >= std::max<double>(sample->range_min, sensor.least_depth) &&
                            range <= std::min<double>(sample->range_max, sensor.greatest_depth);
      if (!is_there && !is_too_near) {
        out.push_back({kMissing, kMissing, kMissing, 0.0F});
        continue;
      }
      const double end = is_too_near ? sample->range_min : range, error = sensor.error_at(end);
      const double middle = is_too_near ? 0.5 * end : end;
      // Of the place as float32.
      const double rounding = 0x1p-23 * middle;
      const double radius = (end - middle) + error + (end + error) * half_gap + rounding;
      const double angle = sample->angle_min + i * increment;
      out.push_back({static_cast<float>(middle * std::cos(angle)),
                     static_cast<float>(middle * std::sin(angle)), 0.0F,
                     std::nextafter(static_cast<float>(radius * (1.0 + 0x1p-40)),
                                    std::numeric_limits<float>::infinity())});
      excess = std::max(excess, 2.0 * rounding);
    }
    return FrameFault::kNoFault;
  }
  [[nodiscard]] bool is_along_ray(const Sensor&) const noexcept override { return true; }
  [[nodiscard]] std::uint32_t depth_digest(std::size_t i) const noexcept override {
    return digest_of_depth(ranges()[i]);
  }

 private:
  [[nodiscard]] std::span<const float> ranges() const noexcept {
    return {sample->ranges._buffer, sample->ranges._length};
  }

  // The negated comparisons refuse NaN.
  [[nodiscard]] FrameFault judge(const Sensor& sensor) const noexcept {
    if (columns == 0) return FrameFault::kNoPixels;
    if (columns > sensor.most_points) return FrameFault::kTooManyPixels;
    const double between = columns - 1, increment = sample->angle_increment;
    const double step = std::abs(increment), last = sample->angle_min + between * increment;
    // Some drivers count one ray more or less between the angles.
    const bool fits =
        std::isfinite(last) && (columns == 1 || step > 0.0) &&
        std::abs(last - sample->angle_max) <= 1.5 * step + 1e-4 &&
        between * step <= 2.0 * std::numbers::pi + step &&
        std::max(std::abs<double>(sample->angle_min), std::abs(last)) <= kLargestAngle;
    if (!fits || !(sample->scan_time >= 0.0F) ||
        !(sample->range_min >= 0.0F && sample->range_min <= sample->range_max))
      return FrameFault::kLayout;
    if (step > kWidestIncrement) return FrameFault::kWideRays;
    // A driver that does not say when each ray was measured says how long a turn takes.
    const double turn_s =
        sample->scan_time > 0.0F ? sample->scan_time * step / (2.0 * std::numbers::pi) : 0.0;
    const double ray_s =
        sample->time_increment == 0.0F ? turn_s : std::abs(double{sample->time_increment});
    return 1e9 * between * ray_s <= static_cast<double>(sensor.stamp_error_ns)
               ? FrameFault::kNoFault
               : FrameFault::kLongScan;
  }
};

}  // namespace clearance
