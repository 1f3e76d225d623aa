#include "core/pose.hpp"

#include <cmath>

namespace clearance {
namespace {

using Quat = Eigen::Quaterniond;

Quat unit(const Quat& q) noexcept {
  const double norm = std::sqrt(q.w() * q.w() + q.x() * q.x() + q.y() * q.y() + q.z() * q.z());
  return {q.w() / norm, q.x() / norm, q.y() / norm, q.z() / norm};
}

}  // namespace

Vec3 transform(const Pose& pose, const Vec3& point) noexcept {
  return unit(pose.orientation).toRotationMatrix() * point + pose.position;
}

Pose compose(const Pose& outer, const Pose& inner) noexcept {
  return {transform(outer, inner.position), unit(outer.orientation) * unit(inner.orientation)};
}

}  // namespace clearance
