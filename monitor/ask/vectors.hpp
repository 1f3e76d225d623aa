// Small operations on vectors in a fixed order.
#pragma once

#include <cmath>

#include "monitor/bodies/fixed_order.hpp"

namespace clearance {

[[nodiscard]] inline double length(const Vec3& v) noexcept { return std::sqrt(dot(v, v)); }

[[nodiscard]] inline Vec3 times_transposed(const Mat3& m, const Vec3& v) noexcept {
  return {(m(0, 0) * v.x() + m(1, 0) * v.y()) + m(2, 0) * v.z(),
          (m(0, 1) * v.x() + m(1, 1) * v.y()) + m(2, 1) * v.z(),
          (m(0, 2) * v.x() + m(1, 2) * v.y()) + m(2, 2) * v.z()};
}

}  // namespace clearance
