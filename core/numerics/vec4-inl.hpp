// Vectors of three doubles in registers of four, for the code that is compiled once per vector
// width (hwy/foreach_target.h). There are two registers of two at the x86-64 baseline and on Arm,
// and one of four with AVX2. The value of the fourth lane never matters. Every operation is
// elementwise on IEEE doubles, and sums have a fixed order. So the width does not change a bit of a
// result.
#if defined(CLEARANCE_CORE_VEC4) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_VEC4
#undef CLEARANCE_CORE_VEC4
#else
#define CLEARANCE_CORE_VEC4
#endif

#include <hwy/highway.h>

#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/vec.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// Two doubles of a register of two, on any target.
using Vec2 = double __attribute__((vector_size(16)));

#if HWY_TARGET <= HWY_AVX2
using Doubles = double __attribute__((vector_size(32)));
using Bits = std::int64_t __attribute__((vector_size(32)));

struct Vec4 {
  Doubles v;
};
HWY_INLINE Vec4 vec4(double x, double y, double z, double w) { return {Doubles{x, y, z, w}}; }
HWY_INLINE double lane(Vec4 a, int i) { return a.v[i]; }
HWY_INLINE Vec4 operator+(Vec4 a, Vec4 b) { return {a.v + b.v}; }
HWY_INLINE Vec4 operator-(Vec4 a, Vec4 b) { return {a.v - b.v}; }
HWY_INLINE Vec4 operator*(Vec4 a, Vec4 b) { return {a.v * b.v}; }
HWY_INLINE Vec4 operator/(Vec4 a, Vec4 b) { return {a.v / b.v}; }
// Lane n of the result is lane i, j, k, l of a (0 to 3) or of b (4 to 7).
template <int i, int j, int k, int l>
HWY_INLINE Vec4 pick(Vec4 a, Vec4 b) {
  return {__builtin_shufflevector(a.v, b.v, i, j, k, l)};
}
// Tells which lanes of a are less than those of b: a bit each.
HWY_INLINE unsigned less(Vec4 a, Vec4 b) {
  return static_cast<unsigned>(__builtin_ia32_movmskpd256(Doubles(a.v < b.v)));
}
// Tells which lanes of a are at least those of b; none of NaN.
HWY_INLINE unsigned at_least(Vec4 a, Vec4 b) {
  return static_cast<unsigned>(__builtin_ia32_movmskpd256(Doubles(a.v >= b.v)));
}
// Are all four lanes equal?
HWY_INLINE bool equal(Vec4 a, Vec4 b) {
  return __builtin_ia32_movmskpd256(Doubles(a.v == b.v)) == 15;
}
HWY_INLINE Vec4 with_signs(Vec4 a, Vec4 signs) { return {Doubles(Bits(a.v) ^ Bits(signs.v))}; }
// The lanes of x where a is less than b, and those of y elsewhere.
HWY_INLINE Vec4 where_less(Vec4 a, Vec4 b, Vec4 x, Vec4 y) { return {a.v < b.v ? x.v : y.v}; }
// The fourth lane zero.
HWY_INLINE Vec4 first3(Vec4 a) { return {Doubles(Bits(a.v) & Bits{-1, -1, -1, 0})}; }
HWY_INLINE Vec2 low2(Vec4 a) { return __builtin_shufflevector(a.v, a.v, 0, 1); }
HWY_INLINE Vec2 high2(Vec4 a) { return __builtin_shufflevector(a.v, a.v, 2, 3); }

#else
using Doubles = double __attribute__((vector_size(16)));
using Bits = std::int64_t __attribute__((vector_size(16)));

struct Vec4 {
  Doubles v[2];
};
HWY_INLINE Vec4 vec4(double x, double y, double z, double w) {
  return {{Doubles{x, y}, Doubles{z, w}}};
}
HWY_INLINE double lane(Vec4 a, int i) { return a.v[i / 2][i % 2]; }
HWY_INLINE Vec4 operator+(Vec4 a, Vec4 b) { return {{a.v[0] + b.v[0], a.v[1] + b.v[1]}}; }
HWY_INLINE Vec4 operator-(Vec4 a, Vec4 b) { return {{a.v[0] - b.v[0], a.v[1] - b.v[1]}}; }
HWY_INLINE Vec4 operator*(Vec4 a, Vec4 b) { return {{a.v[0] * b.v[0], a.v[1] * b.v[1]}}; }
HWY_INLINE Vec4 operator/(Vec4 a, Vec4 b) { return {{a.v[0] / b.v[0], a.v[1] / b.v[1]}}; }
template <int i>
HWY_INLINE Doubles half(Vec4 a, Vec4 b) {
  return i < 4 ? a.v[i / 2 % 2] : b.v[i / 2 % 2];
}
template <int i, int j, int k, int l>
HWY_INLINE Vec4 pick(Vec4 a, Vec4 b) {
  return {{__builtin_shufflevector(half<i>(a, b), half<j>(a, b), i % 2, 2 + j % 2),
           __builtin_shufflevector(half<k>(a, b), half<l>(a, b), k % 2, 2 + l % 2)}};
}
HWY_INLINE unsigned less(Vec4 a, Vec4 b) {
#if HWY_ARCH_X86
  return static_cast<unsigned>(__builtin_ia32_movmskpd(Doubles(a.v[0] < b.v[0])) |
                               __builtin_ia32_movmskpd(Doubles(a.v[1] < b.v[1])) << 2);
#else
  unsigned bits = 0;
  for (int i = 0; i < 4; ++i) bits |= static_cast<unsigned>(lane(a, i) < lane(b, i)) << i;
  return bits;
#endif
}
HWY_INLINE unsigned at_least(Vec4 a, Vec4 b) {
#if HWY_ARCH_X86
  return static_cast<unsigned>(__builtin_ia32_movmskpd(Doubles(a.v[0] >= b.v[0])) |
                               __builtin_ia32_movmskpd(Doubles(a.v[1] >= b.v[1])) << 2);
#else
  unsigned bits = 0;
  for (int i = 0; i < 4; ++i) bits |= static_cast<unsigned>(lane(a, i) >= lane(b, i)) << i;
  return bits;
#endif
}
HWY_INLINE bool equal(Vec4 a, Vec4 b) {
  return lane(a, 0) == lane(b, 0) && lane(a, 1) == lane(b, 1) && lane(a, 2) == lane(b, 2) &&
         lane(a, 3) == lane(b, 3);
}
HWY_INLINE Vec4 with_signs(Vec4 a, Vec4 signs) {
  return {{Doubles(Bits(a.v[0]) ^ Bits(signs.v[0])), Doubles(Bits(a.v[1]) ^ Bits(signs.v[1]))}};
}
HWY_INLINE Vec4 where_less(Vec4 a, Vec4 b, Vec4 x, Vec4 y) {
  return {{a.v[0] < b.v[0] ? x.v[0] : y.v[0], a.v[1] < b.v[1] ? x.v[1] : y.v[1]}};
}
HWY_INLINE Vec4 first3(Vec4 a) { return {{a.v[0], Doubles(Bits(a.v[1]) & Bits{-1, 0})}}; }
HWY_INLINE Vec2 low2(Vec4 a) { return a.v[0]; }
HWY_INLINE Vec2 high2(Vec4 a) { return a.v[1]; }
#endif

template <int i, int j, int k, int l>
HWY_INLINE Vec4 pick(Vec4 a) {
  return pick<i, j, k, l>(a, a);
}
HWY_INLINE Vec4 spread(double s) { return vec4(s, s, s, s); }
// Three doubles, and no more, from memory.
HWY_INLINE Vec4 load3(const double* p) { return vec4(p[0], p[1], p[2], p[2]); }
HWY_INLINE Vec4 load3(const Vec3& p) { return load3(p.data()); }
HWY_INLINE Vec4 load4(const double* p) {
  Vec4 a;
  std::memcpy(&a, p, sizeof a);
  return a;
}
// Three doubles that are followed by another one in the same object.
HWY_INLINE Vec4 load3_padded(const Vec3& p) { return load4(p.data()); }
// Three doubles that are followed by eight bytes of another type in the same object. These bytes
// are masked: integers would be subnormal doubles, which are slow.
HWY_INLINE Vec4 load3_masked(const Vec3& p) { return first3(load4(p.data())); }
HWY_INLINE void store4(Vec4 a, double* p) { std::memcpy(p, &a, sizeof a); }
HWY_INLINE Vec3 vec3(Vec4 a) { return {lane(a, 0), lane(a, 1), lane(a, 2)}; }
HWY_INLINE Vec4 operator*(double s, Vec4 a) { return spread(s) * a; }
HWY_INLINE Vec4 operator-(Vec4 a) { return with_signs(a, spread(-0.0)); }

HWY_INLINE Vec2 vec2(double s) { return Vec2{s, s}; }
HWY_INLINE Vec2 load2(const double* p) {
  Vec2 a;
  std::memcpy(&a, p, sizeof a);
  return a;
}

HWY_INLINE bool both_less(Vec2 a, Vec2 b) {
#if HWY_ARCH_X86
  return __builtin_ia32_movmskpd(Vec2(a < b)) == 3;
#else
  return a[0] < b[0] && a[1] < b[1];
#endif
}
HWY_INLINE bool both_at_most(Vec2 a, Vec2 b) {
#if HWY_ARCH_X86
  return __builtin_ia32_movmskpd(Vec2(a <= b)) == 3;
#else
  return a[0] <= b[0] && a[1] <= b[1];
#endif
}
HWY_INLINE Vec2 magnitudes(Vec2 a) {
  using Words = std::int64_t __attribute__((vector_size(16)));
  return Vec2(Words(a) & Words{INT64_MAX, INT64_MAX});
}
// The sums (x + w) + (z + y) of a's lanes and of b's.
HWY_INLINE Vec2 sums4(Vec4 a, Vec4 b) {
  const Vec4 sums = pick<0, 4, 2, 6>(a, b) + pick<3, 7, 1, 5>(a, b);
  return low2(sums) + high2(sums);
}

HWY_INLINE Vec4 over(Vec4 a, double s) { return a / spread(s); }
HWY_INLINE Vec4 yzx(Vec4 a) { return pick<1, 2, 0, 3>(a); }
HWY_INLINE Vec4 zxy(Vec4 a) { return pick<2, 0, 1, 3>(a); }
// The cross product in the order z, x, y, which takes fewer permutations of registers; and the
// product with a vector that is in this order.
HWY_INLINE Vec4 cross_zxy(Vec4 a, Vec4 b) { return a * yzx(b) - yzx(a) * b; }
HWY_INLINE Vec4 cross_with_zxy(Vec4 a, Vec4 b) { return yzx(a) * b - zxy(a) * zxy(b); }
HWY_INLINE Vec4 cross(Vec4 a, Vec4 b) { return yzx(cross_zxy(a, b)); }
HWY_INLINE double sum3(Vec4 a) { return (lane(a, 0) + lane(a, 1)) + lane(a, 2); }
HWY_INLINE double dot(Vec4 a, Vec4 b) { return sum3(a * b); }
HWY_INLINE double norm(Vec4 a) { return std::sqrt(dot(a, a)); }
HWY_INLINE double dot_zxy(Vec4 a, Vec4 b) {
  const Vec4 products = a * b;
  return (lane(products, 1) + lane(products, 2)) + lane(products, 0);
}
// (v x e).n
HWY_INLINE double triple(Vec4 v, Vec4 e, Vec4 n) { return dot_zxy(cross_zxy(v, e), zxy(n)); }
// e x (v x e) and |v x e|.
HWY_INLINE void double_cross(Vec4 v, Vec4 e, Vec4& product, double& length) {
  const Vec4 c = cross_zxy(v, e);
  product = cross_with_zxy(e, c);
  length = std::sqrt(dot_zxy(c, c));
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
