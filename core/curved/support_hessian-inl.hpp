// The support point and the support Hessian of a body's round parts along a direction. Compiled
// once per vector width: see core/numerics/vec4-inl.hpp.
//
// A part is its middle plus `radius` times D B (RoundParts). Along x, of any length, the support
// function of D B is sqrt(x.S x), with S = D^2 in the body's axes. Its gradient is S x / sqrt(x.S
// x), and its second derivative is (S - S x (S x)^T / x.S x) / sqrt(x.S x). These are accurate
// enough for a step of the direction, but not for the last digit of a bound.
#if defined(CLEARANCE_CORE_SUPPORT_HESSIAN) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_SUPPORT_HESSIAN
#undef CLEARANCE_CORE_SUPPORT_HESSIAN
#else
#define CLEARANCE_CORE_SUPPORT_HESSIAN
#endif

#include <cmath>

#include "core/curved/body_support-inl.hpp"
#include "core/model/relative_pose-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// A symmetric matrix by its diagonal and by its entries xy, yz, zx.
struct Symmetric4 {
  Vec4 main, beside;
};
HWY_INLINE Vec4 operator*(const Symmetric4& m, Vec4 v) {
  return (m.main * v + m.beside * yzx(v)) + zxy(m.beside) * zxy(v);
}
HWY_INLINE double trace(const Symmetric4& m) { return sum3(m.main); }

// The inverse times the determinant, and the determinant in each of the first three lanes.
struct Cofactors {
  Symmetric4 matrix;
  Vec4 determinant;
};
HWY_INLINE Cofactors cofactors(const Symmetric4& m) {
  const Vec4 y = yzx(m.main), z = zxy(m.main), yz = yzx(m.beside), zx = zxy(m.beside);
  const Symmetric4 c{y * z - yz * yz, yz * zx - m.beside * z};
  return {c, (m.main * c.main + m.beside * c.beside) + zx * zxy(c.beside)};
}

// S of a polyhedron is zero, since its parts are points.
struct NoSquares {
  static constexpr bool kRound = false;
};
// S of A, whose axes are the frame's.
struct SquaresOfA {
  static constexpr bool kRound = true;
  Vec4 squares;
  [[nodiscard]] HWY_INLINE Vec4 times(Vec4 x) const { return squares * x; }
  [[nodiscard]] HWY_INLINE Symmetric4 less(Vec4 v, Vec4 scaled) const {
    return {squares - v * scaled, -(yzx(v) * scaled)};
  }
};
struct SquaresOfB {
  static constexpr bool kRound = true;
  Symmetric4 squares;
  [[nodiscard]] HWY_INLINE Vec4 times(Vec4 x) const { return squares * x; }
  [[nodiscard]] HWY_INLINE Symmetric4 less(Vec4 v, Vec4 scaled) const {
    return {squares.main - v * scaled, squares.beside - yzx(v) * scaled};
  }
};

HWY_INLINE SquaresOfA squares_of_a(const Side& side) {
  return {side.semi_axes() * side.semi_axes()};
}
// R diag(squares) R^T.
HWY_INLINE SquaresOfB squares_of_b(const Side& side, const Diagonals& r) {
  const Vec4 s = side.semi_axes() * side.semi_axes();
  const Vec4 main = r.main * s, next = r.next * yzx(s), last = r.last * zxy(s);
  return {{(r.main * main + r.next * next) + r.last * last,
           (main * yzx(r.last) + next * yzx(r.main)) + last * yzx(r.next)}};
}

// D B along x.
struct RoundSupport {
  Vec4 point, squared;  // the support point, and S x
  Symmetric4 hessian;   // the second derivative
  double value = 0.0;   // the support value times |x|
  double square = 1.0;  // the square of `value`
};
template <class Squares>
HWY_INLINE RoundSupport unit_support(const Squares& squares, Vec4 x) {
  RoundSupport found;
  found.squared = squares.times(x);
  found.square = dot(x, found.squared);
  found.value = std::sqrt(found.square);
  // The division does not wait for the square root.
  const double inverse = 1.0 / found.square, part = found.value * inverse;
  const Symmetric4 rest = squares.less(found.squared, inverse * found.squared);
  found.point = part * found.squared;
  found.hessian = {part * rest.main, part * rest.beside};
  return found;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
