// Vectors of numbers that record their roundings, with sums in the order of the core.
#pragma once

#include <array>

#include "core/vec.hpp"
#include "tests/core/model/counted.hpp"

namespace clearance::test {

using Counted3 = std::array<Counted, 3>;

inline Counted3 counted(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Counted3 operator+(const Counted3& a, const Counted3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Counted3 operator-(const Counted3& a, const Counted3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Counted dot(const Counted3& a, const Counted3& b) {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}
inline Counted norm(const Counted3& a) { return sqrt(dot(a, a)); }

}  // namespace clearance::test
