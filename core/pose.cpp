#include "core/pose.hpp"

namespace clearance {
Vec3 transform(const Pose& pose, const Vec3& point) noexcept {
  return rotation_matrix(pose.orientation) * point + pose.position;
}

Pose compose(const Pose& outer, const Pose& inner) noexcept {
  const Eigen::Quaterniond& a = outer.orientation;
  const Eigen::Quaterniond& b = inner.orientation;
  return {transform(outer, inner.position), Eigen::Quaterniond(a * b).normalized()};
}

}  // namespace clearance
