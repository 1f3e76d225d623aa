// The value of an input that was refused last, for people. Rounded to floats.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/inputs/joint_batch.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

struct RefusedValue {
  Reject cause = Reject::kCount;  // kCount: none was refused
  bool is_joint = false;
  std::array<float, 7> value{};  // x y z, qx qy qz qw; of a joint its position
  float speed = 0.0F;            // m/s; of a joint its velocity; NaN: none was sent
  std::int64_t ahead_ns = 0;     // its stamp less the time of the tick, as it was sent

  RefusedValue() = default;
  RefusedValue(Reject of, const PoseSample& sample, std::int64_t now_ns) noexcept
      : cause(of),
        speed(sample.has_twist ? rounded(sample.twist.linear.norm()) : kNotSent),
        ahead_ns(less(sample.stamp_ns, now_ns)) {
    const Vec3& p = sample.world_from_object.position;
    const Eigen::Quaterniond& q = sample.world_from_object.orientation;
    value = {rounded(p.x()), rounded(p.y()), rounded(p.z()), rounded(q.x()),
             rounded(q.y()), rounded(q.z()), rounded(q.w())};
  }
  RefusedValue(Reject of, const JointSample& sample, std::int64_t now_ns) noexcept
      : cause(of),
        is_joint(true),
        speed(sample.has_velocity ? rounded(sample.velocity) : kNotSent),
        ahead_ns(less(sample.stamp_ns, now_ns)) {
    value[0] = rounded(sample.position);
  }

 private:
  static constexpr float kNotSent = std::numeric_limits<float>::quiet_NaN();

  // Infinite beyond the range of floats, where a conversion is undefined.
  static float rounded(double value) noexcept {
    constexpr double kMost = std::numeric_limits<float>::max();
    if (std::abs(value) <= kMost || std::isnan(value)) return static_cast<float>(value);
    return std::copysign(std::numeric_limits<float>::infinity(), value > 0.0 ? 1.0F : -1.0F);
  }
};

}  // namespace clearance
