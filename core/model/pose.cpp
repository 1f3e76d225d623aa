#include "core/pose.hpp"

namespace clearance {

Vec3 transform(const Pose& pose, const Vec3& point) noexcept {
  return rotation_matrix(pose.orientation) * point + pose.position;
}

Pose compose(const Pose& outer, const Pose& inner) noexcept {
  return {transform(outer, inner.position), (outer.orientation * inner.orientation).normalized()};
}

}  // namespace clearance
