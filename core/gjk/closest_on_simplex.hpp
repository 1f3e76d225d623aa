// The point of a simplex (up to four points) that is closest to the origin, in twice double
// precision.
#pragma once

#include <array>
#include <cstddef>

#include "core/numerics/double_double.hpp"
#include "core/vec.hpp"

namespace clearance {

struct WideVec {
  DoubleDouble x, y, z;
};

inline WideVec wide(const Vec3& v) noexcept { return {v.x(), v.y(), v.z()}; }
inline Vec3 narrow(const WideVec& v) noexcept {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
inline WideVec operator+(const WideVec& a, const WideVec& b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline WideVec operator-(const WideVec& a, const WideVec& b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline WideVec operator*(const DoubleDouble& s, const WideVec& v) noexcept {
  return {s * v.x, s * v.y, s * v.z};
}
inline DoubleDouble dot(const WideVec& a, const WideVec& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline WideVec cross(const WideVec& a, const WideVec& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct ClosestPoint {
  WideVec point;                        // of the simplex, closest to the origin
  std::array<DoubleDouble, 4> weights;  // of its vertices, >= 0, sum 1; 0 for those not needed
  DoubleDouble length2;                 // |point|^2
};

// points[0, size): any, degenerate simplices included. The newest is last.
[[nodiscard]] ClosestPoint closest_to_origin(const std::array<WideVec, 4>& points,
                                             std::size_t size) noexcept;

}  // namespace clearance
