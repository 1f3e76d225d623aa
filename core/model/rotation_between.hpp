// The shortest rotation between two directions.
#pragma once

#include <cmath>

#include "core/vec.hpp"

namespace clearance {

// Takes the direction `from` to the direction `to`; neither is zero. Its angle is the least one to
// 3e-6 rad. Opposite directions are rotated by a half-turn about an axis across them. Eigen's
// FromTwoVectors is the same, but its singular value decomposition takes the compiler seconds.
[[nodiscard]] inline Eigen::Quaterniond rotation_between(const Vec3& from, const Vec3& to) {
  const Vec3 a = from.normalized(), b = to.normalized();
  const Vec3 sum = a + b;           // twice the cosine of half the angle long
  if (sum.squaredNorm() < 1e-12) {  // the cross product has lost its direction
    Eigen::Index least = 0;
    a.cwiseAbs().minCoeff(&least);
    const Vec3 across = a.cross(Vec3::Unit(least)).normalized();
    return rotation_between(-a, b) * Eigen::Quaterniond(0.0, across.x(), across.y(), across.z());
  }
  Eigen::Quaterniond rotation;
  rotation.vec() = a.cross(b);
  rotation.w() = 0.5 * sum.squaredNorm();
  rotation.normalize();
  return rotation;
}

}  // namespace clearance
