// Products of vectors, matrices and quaternions in a fixed order of operations. Eigen's order
// differs between processors, but ticks must give the same bits on every machine.
#pragma once

#include "core/pose.hpp"

namespace clearance {

[[nodiscard]] inline Eigen::Quaterniond product(const Eigen::Quaterniond& a,
                                                const Eigen::Quaterniond& b) noexcept {
  return {((a.w() * b.w() - a.x() * b.x()) - a.y() * b.y()) - a.z() * b.z(),
          ((a.w() * b.x() + a.x() * b.w()) + a.y() * b.z()) - a.z() * b.y(),
          ((a.w() * b.y() + a.y() * b.w()) + a.z() * b.x()) - a.x() * b.z(),
          ((a.w() * b.z() + a.z() * b.w()) + a.x() * b.y()) - a.y() * b.x()};
}

[[nodiscard]] inline double dot(const Vec3& a, const Vec3& b) noexcept {
  return (a.x() * b.x() + a.y() * b.y()) + a.z() * b.z();
}

[[nodiscard]] inline Vec3 cross(const Vec3& a, const Vec3& b) noexcept {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(),
          a.x() * b.y() - a.y() * b.x()};
}

[[nodiscard]] inline Vec3 times(const Mat3& m, const Vec3& v) noexcept {
  return {(m(0, 0) * v.x() + m(0, 1) * v.y()) + m(0, 2) * v.z(),
          (m(1, 0) * v.x() + m(1, 1) * v.y()) + m(1, 2) * v.z(),
          (m(2, 0) * v.x() + m(2, 1) * v.y()) + m(2, 2) * v.z()};
}

}  // namespace clearance
