// By how little two rays of two bodies lean apart, and which way; and on which side of a plane
// of one body a ray of the other ends: where only the last digits of the quaternions say it, be
// they subnormal.
//
// The relative quaternion q is a sum of products of doubles, and so is N(q), |q|^2 times the
// rotation. All of them are exact here, at any exponent (core/numerics/long_sum.hpp), so that
// nothing has to be near to anything for a sign to be known.
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "core/convex_polyhedron.hpp"
#include "core/gjk/closest_on_simplex.hpp"
#include "core/numerics/long_sum.hpp"
#include "core/pose.hpp"

namespace clearance {

[[nodiscard]] LongVec<3> long_vec(const ExactDirection& v) noexcept;
[[nodiscard]] LongVec<3> long_vec(const Vec3& v) noexcept;

// f runs along `sign` times e, plus a positive multiple of `way` (about unit length, to 2^-96 of
// that), or exactly, where way is zero.
struct Apart {
  double sign = 1.0;
  WideVec way;
};

// To about unit length, each component to 2^-104 of that; zero stays zero.
template <int kFactors>
[[nodiscard]] WideVec rounded(const LongVec<kFactors>& v) noexcept {
  int most = -std::numeric_limits<int>::max();
  for (const auto& component : v) {
    if (component.sign() != 0) most = std::max(most, component.exponent());
  }
  const WideVec near{v[0].scaled(-most), v[1].scaled(-most), v[2].scaled(-most)};
  const double length = narrow(near).norm();
  return length > 0.0 ? DoubleDouble(1.0 / length) * near : WideVec{};
}

// f e.e - e e.f stands across e.
template <int kOfE, int kOfF>
[[nodiscard]] Apart apart(const LongVec<kOfE>& e, const LongVec<kOfF>& f) noexcept {
  const auto square = dot(e, e);
  const auto cosine = dot(e, f);
  LongVec<2 * kOfE + kOfF> way;
  for (std::size_t i = 0; i < 3; ++i) {
    way[i].add_product(f[i], square);
    way[i].add_product(cosine, e[i], -1);
  }
  return {cosine.sign() < 0 ? -1.0 : 1.0, rounded(way)};
}

class Lean {
 public:
  // The rotation: that of the pose's quaternions or, if there are none, of its matrix, which is
  // exact then.
  Lean(const RelativePose& a_from_b, bool of_quaternions) noexcept;

  // A direction of B and one of A, in frame A, each times a positive factor.
  [[nodiscard]] LongVec<7> turned(const LongVec<3>& f) const noexcept;
  [[nodiscard]] static LongVec<7> kept(const LongVec<3>& e) noexcept;

 private:
  std::array<LongVec<4>, 3> rows_;  // N(q)
};

}  // namespace clearance
