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

// On the straight way from one pose to another with an even turn, s in [0, 1].
[[nodiscard]] inline Pose between(const Pose& from, const Pose& to, double s) {
  Pose pose;
  pose.position = from.position + s * (to.position - from.position);
  pose.orientation = from.orientation.normalized().slerp(s, to.orientation.normalized());
  return pose;
}

}  // namespace clearance::test
