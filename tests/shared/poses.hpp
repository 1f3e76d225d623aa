// Poses for tests.
#pragma once

#include "core/pose.hpp"

namespace clearance::test {

// The pose without rotation, with the object's origin at this point, m.
[[nodiscard]] inline Pose at(double x, double y, double z) { return {{x, y, z}, {1, 0, 0, 0}}; }

// A rotation about an axis of any length by an angle in rad.
[[nodiscard]] inline Eigen::Quaterniond turned(const Vec3& axis, double angle) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()));
}

// The pose at s in [0, 1] between two poses: on a straight line, with a uniform rotation.
[[nodiscard]] inline Pose between(const Pose& from, const Pose& to, double s) {
  Pose pose;
  pose.position = from.position + s * (to.position - from.position);
  pose.orientation = from.orientation.normalized().slerp(s, to.orientation.normalized());
  return pose;
}

}  // namespace clearance::test
