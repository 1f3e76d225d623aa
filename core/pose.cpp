#include "core/pose.hpp"

namespace clearance {
namespace {

using Quat = Eigen::Quaterniond;

// R(q/|q|) of any non-zero q without a square root: N(q) / |q|^2.
inline Mat3 rotation_matrix(const Quat& q) noexcept {
  const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
  const double s = 2.0 / ((w * w + x * x) + (y * y + z * z));
  Mat3 r;
  r << 1.0 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),  //
      s * (x * y + w * z), 1.0 - s * (x * x + z * z), s * (y * z - w * x),   //
      s * (x * z - w * y), s * (y * z + w * x), 1.0 - s * (x * x + y * y);
  return r;
}

}  // namespace

Vec3 transform(const Pose& pose, const Vec3& point) noexcept {
  return rotation_matrix(pose.orientation) * point + pose.position;
}

Pose compose(const Pose& outer, const Pose& inner) noexcept {
  const Quat& a = outer.orientation;
  const Quat& b = inner.orientation;
  return {transform(outer, inner.position), Quat(a * b).normalized()};
}

}  // namespace clearance
