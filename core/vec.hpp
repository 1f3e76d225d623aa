// The few linear-algebra names that the rooms share. Lengths in metres, angles in radians.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace clearance {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
// Aligned as a double is: Eigen's own has an alignment that depends on how it is compiled.
using Vec2 = Eigen::Matrix<double, 2, 1, Eigen::DontAlign>;

// The types of the library's interface lie in memory as the library was compiled. Every public
// header checks its own types. A switch that would move them is an error when a user is compiled,
// and not a wrong distance.
static_assert(sizeof(Vec3) == 24 && alignof(Vec3) == 8 && sizeof(Vec2) == 16 && alignof(Vec2) == 8);
static_assert(sizeof(Mat3) == 72 && alignof(Mat3) == 8);
static_assert(!Mat3::IsRowMajor,
              "compiled with EIGEN_DEFAULT_TO_ROW_MAJOR: the library stores matrices by columns");

// v 2^exponent: exact, short of over- and underflow.
template <class Vec>
[[nodiscard]] Vec times_power_of_two(const Vec& v, int exponent) noexcept {
  return v.unaryExpr([exponent](double x) { return std::scalbn(x, exponent); });
}

// The unit vector along v. The squares of v may over- or underflow, and v may be subnormal:
// differences of coordinates near the origin are, and axes in robot descriptions. Returns v itself
// if it is zero or not finite.
template <class Vec>
[[nodiscard]] Vec unit_along(const Vec& v) noexcept {
  if (v.isZero(0.0) || !v.allFinite()) return v;
  return times_power_of_two(v, -std::ilogb(v.cwiseAbs().maxCoeff())).normalized();
}

// For assertions: is v of unit length up to some roundings, or unknown (NaN)?
[[nodiscard]] inline bool is_unit_or_unknown(const Vec3& v) noexcept {
  return !(std::abs(v.squaredNorm() - 1.0) > 1e-12);
}

}  // namespace clearance
