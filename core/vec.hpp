// The few linear-algebra names that the rooms share. Lengths in metres, angles in radians.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace clearance {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

// v 2^exponent: exactly, short of over- and underflow.
template <class Vec>
[[nodiscard]] Vec times_power_of_two(const Vec& v, int exponent) noexcept {
  return v.unaryExpr([exponent](double x) { return std::scalbn(x, exponent); });
}

// Of unit length along v, whose squares may over- or underflow, and which may be subnormal; of 0,
// or what is not finite, that.
template <class Vec>
[[nodiscard]] Vec unit_along(const Vec& v) noexcept {
  if (v.isZero(0.0) || !v.allFinite()) return v;
  return times_power_of_two(v, -std::ilogb(v.cwiseAbs().maxCoeff())).normalized();
}

}  // namespace clearance
