// Poses that tests are written with.
#pragma once

#include "core/pose.hpp"

namespace clearance::test {

// Not turned, with the object's origin there, m.
[[nodiscard]] inline Pose at(double x, double y, double z) { return {{x, y, z}, {1, 0, 0, 0}}; }

// About an axis of any length, by an angle in rad.
[[nodiscard]] inline Eigen::Quaterniond turned(const Vec3& axis, double angle) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()));
}

}  // namespace clearance::test
