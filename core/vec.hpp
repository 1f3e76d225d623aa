// The few linear-algebra names that the rooms share. Lengths in metres, angles in radians.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace clearance {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
// Aligned like a double; the alignment of Eigen's own type depends on the compiler's switches.
using Vec2 = Eigen::Matrix<double, 2, 1, Eigen::DontAlign>;

// The memory layout of the interface's types is fixed when the library is compiled. Every public
// header checks its own types. So a switch that would change the layout is an error when a user's
// code is compiled, and not a wrong distance.
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
