// Vectors of three doubles in registers of four, for the code that is compiled once a vector width
// (hwy/foreach_target.h): two registers of two at the x86-64 baseline and on Arm, one of four with
// AVX2. What the fourth lane holds never matters. Every operation is an elementwise one of IEEE
// doubles, and sums have a fixed order: the width does not change a bit.
#if defined(CLEARANCE_CORE_QUAD) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_QUAD
#undef CLEARANCE_CORE_QUAD
#else
#define CLEARANCE_CORE_QUAD
#endif

#include <hwy/highway.h>

#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/vec.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

#if HWY_TARGET <= HWY_AVX2
using Doubles = double __attribute__((vector_size(32)));
using Bits = std::int64_t __attribute__((vector_size(32)));

struct Quad {
  Doubles v;
};
HWY_INLINE Quad quad(double x, double y, double z, double w) { return {Doubles{x, y, z, w}}; }
HWY_INLINE double lane(Quad a, int i) { return a.v[i]; }
HWY_INLINE Quad operator+(Quad a, Quad b) { return {a.v + b.v}; }
HWY_INLINE Quad operator-(Quad a, Quad b) { return {a.v - b.v}; }
HWY_INLINE Quad operator*(Quad a, Quad b) { return {a.v * b.v}; }
HWY_INLINE Quad operator/(Quad a, Quad b) { return {a.v / b.v}; }
// Lane n of the result is lane i, j, k, l of a (0 to 3) or of b (4 to 7).
template <int i, int j, int k, int l>
HWY_INLINE Quad pick(Quad a, Quad b) {
  return {__builtin_shufflevector(a.v, b.v, i, j, k, l)};
}
// Which lanes of a are less than those of b: a bit each.
HWY_INLINE unsigned less(Quad a, Quad b) {
  return static_cast<unsigned>(__builtin_ia32_movmskpd256(Doubles(a.v < b.v)));
}
HWY_INLINE Quad with_signs(Quad a, Quad signs) { return {Doubles(Bits(a.v) ^ Bits(signs.v))}; }
// The fourth lane zero.
HWY_INLINE Quad first3(Quad a) { return {Doubles(Bits(a.v) & Bits{-1, -1, -1, 0})}; }

#else
using Doubles = double __attribute__((vector_size(16)));
using Bits = std::int64_t __attribute__((vector_size(16)));

struct Quad {
  Doubles v[2];
};
HWY_INLINE Quad quad(double x, double y, double z, double w) {
  return {{Doubles{x, y}, Doubles{z, w}}};
}
HWY_INLINE double lane(Quad a, int i) { return a.v[i / 2][i % 2]; }
HWY_INLINE Quad operator+(Quad a, Quad b) { return {{a.v[0] + b.v[0], a.v[1] + b.v[1]}}; }
HWY_INLINE Quad operator-(Quad a, Quad b) { return {{a.v[0] - b.v[0], a.v[1] - b.v[1]}}; }
HWY_INLINE Quad operator*(Quad a, Quad b) { return {{a.v[0] * b.v[0], a.v[1] * b.v[1]}}; }
HWY_INLINE Quad operator/(Quad a, Quad b) { return {{a.v[0] / b.v[0], a.v[1] / b.v[1]}}; }
template <int i>
HWY_INLINE Doubles half(Quad a, Quad b) {
  return i < 4 ? a.v[i / 2 % 2] : b.v[i / 2 % 2];
}
template <int i, int j, int k, int l>
HWY_INLINE Quad pick(Quad a, Quad b) {
  return {{__builtin_shufflevector(half<i>(a, b), half<j>(a, b), i % 2, 2 + j % 2),
           __builtin_shufflevector(half<k>(a, b), half<l>(a, b), k % 2, 2 + l % 2)}};
}
HWY_INLINE unsigned less(Quad a, Quad b) {
#if HWY_ARCH_X86
  return static_cast<unsigned>(__builtin_ia32_movmskpd(Doubles(a.v[0] < b.v[0])) |
                               __builtin_ia32_movmskpd(Doubles(a.v[1] < b.v[1])) << 2);
#else
  unsigned bits = 0;
  for (int i = 0; i < 4; ++i) bits |= static_cast<unsigned>(lane(a, i) < lane(b, i)) << i;
  return bits;
#endif
}
HWY_INLINE Quad with_signs(Quad a, Quad signs) {
  return {{Doubles(Bits(a.v[0]) ^ Bits(signs.v[0])), Doubles(Bits(a.v[1]) ^ Bits(signs.v[1]))}};
}
HWY_INLINE Quad first3(Quad a) { return {{a.v[0], Doubles(Bits(a.v[1]) & Bits{-1, 0})}}; }
#endif

template <int i, int j, int k, int l>
HWY_INLINE Quad pick(Quad a) {
  return pick<i, j, k, l>(a, a);
}
HWY_INLINE Quad spread(double s) { return quad(s, s, s, s); }
// Three doubles, and no more, from memory.
HWY_INLINE Quad load3(const double* p) { return quad(p[0], p[1], p[2], p[2]); }
HWY_INLINE Quad load3(const Vec3& p) { return load3(p.data()); }
HWY_INLINE Quad load4(const double* p) {
  Quad a;
  std::memcpy(&a, p, sizeof a);
  return a;
}
// Three doubles that another one follows in the same object.
HWY_INLINE Quad load3_of_4(const Vec3& p) { return load4(p.data()); }
// Three doubles that something else of eight bytes follows in the same object. It is not let in:
// integers would be subnormal doubles, which are slow.
HWY_INLINE Quad load3_alone(const Vec3& p) { return first3(load4(p.data())); }
HWY_INLINE void store4(Quad a, double* p) { std::memcpy(p, &a, sizeof a); }
HWY_INLINE Vec3 vec3(Quad a) { return {lane(a, 0), lane(a, 1), lane(a, 2)}; }
HWY_INLINE Quad operator*(double s, Quad a) { return spread(s) * a; }
HWY_INLINE Quad operator-(Quad a) { return with_signs(a, spread(-0.0)); }

// Two doubles of a register of two, on any target.
using Pair = double __attribute__((vector_size(16)));
HWY_INLINE Pair pair(double s) { return Pair{s, s}; }
HWY_INLINE Pair load2(const double* p) {
  Pair a;
  std::memcpy(&a, p, sizeof a);
  return a;
}

HWY_INLINE bool both_less(Pair a, Pair b) {
#if HWY_ARCH_X86
  return __builtin_ia32_movmskpd(Pair(a < b)) == 3;
#else
  return a[0] < b[0] && a[1] < b[1];
#endif
}

HWY_INLINE Quad yzx(Quad a) { return pick<1, 2, 0, 3>(a); }
HWY_INLINE Quad zxy(Quad a) { return pick<2, 0, 1, 3>(a); }
HWY_INLINE Quad cross(Quad a, Quad b) { return yzx(a) * zxy(b) - zxy(a) * yzx(b); }
HWY_INLINE double sum3(Quad a) { return (lane(a, 0) + lane(a, 1)) + lane(a, 2); }
HWY_INLINE double dot(Quad a, Quad b) { return sum3(a * b); }
HWY_INLINE double norm(Quad a) { return std::sqrt(dot(a, a)); }

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
