// How the curved pieces of a body are round, all of them alike, and what of that a direction sees.
// Compiled once a vector width: see core/numerics/vec4-inl.hpp.
//
// A piece is its middle and `radius` times the body's unit: an ellipsoid's image of the unit ball,
// or a truncated cone's unit disc. Along x, of any length, the unit's support function is
// sqrt(x.S x), S being the squares of the semi-axes along the body's axes (1, 1 and 0 of a disc):
// good to a step of the direction, but not to the last digit of a bound.
#if defined(CLEARANCE_CORE_ROUNDNESS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_ROUNDNESS
#undef CLEARANCE_CORE_ROUNDNESS
#else
#define CLEARANCE_CORE_ROUNDNESS
#endif

#include <cmath>

#include "core/convex_body.hpp"
#include "core/model/relative_pose-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// By its diagonal and what stands beside that: xy, yz, zx.
struct Symmetric4 {
  Vec4 main, beside;
};
HWY_INLINE Vec4 operator*(const Symmetric4& m, Vec4 v) {
  return (m.main * v + m.beside * yzx(v)) + zxy(m.beside) * zxy(v);
}
HWY_INLINE double trace(const Symmetric4& m) { return sum3(m.main); }

// Its inverse times its determinant, and that determinant in each of the first three lanes.
struct Cofactors {
  Symmetric4 matrix;
  Vec4 determinant;
};
HWY_INLINE Cofactors cofactors(const Symmetric4& m) {
  const Vec4 y = yzx(m.main), z = zxy(m.main), yz = yzx(m.beside), zx = zxy(m.beside);
  const Symmetric4 c{y * z - yz * yz, yz * zx - m.beside * z};
  return {c, (m.main * c.main + m.beside * c.beside) + zx * zxy(c.beside)};
}

// A polyhedron's vertices.
struct NoRoundness {
  static constexpr bool kRound = false;
};
// Of A, whose axes are the frame's.
struct RoundnessOfA {
  static constexpr bool kRound = true;
  Vec4 squares;
  [[nodiscard]] HWY_INLINE Vec4 times(Vec4 x) const { return squares * x; }
  [[nodiscard]] HWY_INLINE Symmetric4 less(Vec4 v, Vec4 scaled) const {
    return {squares - v * scaled, -(yzx(v) * scaled)};
  }
};
struct RoundnessOfB {
  static constexpr bool kRound = true;
  Symmetric4 squares;
  [[nodiscard]] HWY_INLINE Vec4 times(Vec4 x) const { return squares * x; }
  [[nodiscard]] HWY_INLINE Symmetric4 less(Vec4 v, Vec4 scaled) const {
    return {squares.main - v * scaled, squares.beside - yzx(v) * scaled};
  }
};

HWY_INLINE Vec4 unit_squares(const ConvexBody& body) {
  if (body.curved.kind == CurvedShape::Kind::kTruncatedCone) return vec4(1.0, 1.0, 0.0, 0.0);
  const Vec4 semi_axes = load3(body.curved.semi_axes);
  return semi_axes * semi_axes;
}
HWY_INLINE RoundnessOfA roundness_of_a(const ConvexBody& body) { return {unit_squares(body)}; }
// R diag(squares) R^T.
HWY_INLINE RoundnessOfB roundness_of_b(const ConvexBody& body, const Diagonals& turn) {
  const Vec4 s = unit_squares(body);
  const Vec4 main = turn.main * s, next = turn.next * yzx(s), last = turn.last * zxy(s);
  return {{(turn.main * main + turn.next * next) + turn.last * last,
           (main * yzx(turn.last) + next * yzx(turn.main)) + last * yzx(turn.next)}};
}

// Along x: the unit's support point, how that moves when x turns, and S x.
struct RoundView {
  Vec4 out, squared;
  Symmetric4 turn;
  double reach = 0.0;   // along x, times |x|
  double square = 1.0;  // of that
};
template <class Roundness>
HWY_INLINE RoundView view(const Roundness& roundness, Vec4 x) {
  RoundView seen;
  seen.squared = roundness.times(x);
  seen.square = dot(x, seen.squared);
  seen.reach = std::sqrt(seen.square);
  // Beside the square root, not behind it.
  const double inverse = 1.0 / seen.square, part = seen.reach * inverse;
  const Symmetric4 turn = roundness.less(seen.squared, inverse * seen.squared);
  seen.out = part * seen.squared;
  seen.turn = {part * turn.main, part * turn.beside};
  return seen;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
