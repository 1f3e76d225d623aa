// One step of Newton's method on the direction. It evaluates the active parts of two bodies along
// the direction, and finds the direction that makes the least of their distances greatest. Compiled
// once a vector width: see core/numerics/vec4-inl.hpp.
//
// The step of one active pair solves (K + d I) s' = w. Here w is the gap vector, d is the distance,
// and K is the sum of the support Hessians. So K n = 0 and w.n = d. Then s' = n + s is already the
// next direction, with s the step on the tangent plane.
//
// Directions may have any length. For x = l n, the distance is 1/l times that along n, and the
// radii of curvature are 1/l^2 times theirs. The step stays the same. Only the certificate needs a
// unit direction.
//
// If bodies nearly touch, K + d I is nearly singular along n, and its determinant is rounding. The
// step then takes its length from x.(x + s) = x.x and not from the determinant. If the
// regularisation of K differs from d, along n or across it, w changes along n by the difference.
// This gives the same step.
#if defined(CLEARANCE_CORE_NEWTON_STEP) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_NEWTON_STEP
#undef CLEARANCE_CORE_NEWTON_STEP
#else
#define CLEARANCE_CORE_NEWTON_STEP
#endif

#include <algorithm>
#include <cmath>

#include "core/curved/placed_parts-inl.hpp"
#include "core/curved/support_hessian-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// Bodies nearly touch if the distance is less than this share of the radii of curvature. The
// determinant has then lost ten bits, and the weights of several parts would be rounding.
inline constexpr double kNearlySingular = 0x1p-10;

template <class SquaresA, class SquaresB>
class NewtonStep {
 public:
  HWY_INLINE NewtonStep(const SquaresA& a, const SquaresB& b) : squares_a_(a), squares_b_(b) {}

  // Evaluates the parts along x, and sets `least` and the round supports.
  HWY_INLINE void evaluate(PlacedParts& parts, Vec4 x) {
    square = dot(x, x);
    if constexpr (SquaresA::kRound) round_a = unit_support(squares_a_, x);
    if constexpr (SquaresB::kRound) round_b = unit_support(squares_b_, x);
    per_square_ = 1.0 / square;
    least = evaluate(parts, x, 0);
    for (std::size_t i = 1; i < parts.count(); ++i) least = std::min(least, evaluate(parts, x, i));
  }

  // Steps from x, for which evaluate() was called, to `next`, and finds the weights of the parts
  // there. A part without weight is dropped. The weights decide which parts' Hessians count, so
  // they are found twice where the Hessians differ.
  HWY_INLINE void solve(PlacedParts& parts, Vec4 x) {
    set_regularisation(parts);
    solve_once(parts, x);
    if (HWY_LIKELY(parts.count() == 1)) return;
    const bool same = parts.radius_a[0] == parts.radius_a[1] &&  //
                      parts.radius_b[0] == parts.radius_b[1];
    if (!same) solve_once(parts, x);
  }

  Vec4 next;
  RoundSupport round_a, round_b;
  double square = 1.0;  // of x
  double least = 0.0;   // the distance of the nearest pair of parts, times the length of x
  double trace = 0.0;   // of the step's matrix

 private:
  // The distance of a pair of parts, times the length of x.
  HWY_INLINE double evaluate(PlacedParts& parts, Vec4 x, std::size_t i) {
    Vec4 w = parts.middle[i];
    double value = dot(x, w);
    if constexpr (SquaresA::kRound) {
      w = w - parts.radius_a[i] * round_a.point;
      value -= parts.radius_a[i] * round_a.value;
    }
    if constexpr (SquaresB::kRound) {
      w = w - parts.radius_b[i] * round_b.point;
      value -= parts.radius_b[i] * round_b.value;
    }
    parts.gap[i] = w;
    return value;
  }

  // On the unit sphere, the curvature adds the distance d to the Hessian, which regularises it.
  // While the direction is far from the best one, half the length of the gap vector replaces d.
  HWY_INLINE void set_regularisation(const PlacedParts& parts) {
    regularisation_ = least * per_square_;
    const double gap = dot(parts.gap[0], parts.gap[0]);
    const bool far_off =
        parts.count() == 1 ? 4.0 * least * std::abs(least) < gap * square : !(least > 0.0);
    if (HWY_UNLIKELY(far_off)) regularisation_ = 0.5 * std::sqrt(gap * per_square_);
  }

  [[nodiscard]] HWY_INLINE Symmetric4 matrix(const PlacedParts& parts) const {
    Symmetric4 m{spread(regularisation_), spread(0.0)};
    double radius_a = parts.radius_a[0], radius_b = parts.radius_b[0];
    if (parts.count() > 1) {
      radius_a = radius_b = 0.0;
      for (std::size_t i = 0; i < parts.count(); ++i) {
        radius_a += parts.weight[i] * parts.radius_a[i];
        radius_b += parts.weight[i] * parts.radius_b[i];
      }
    }
    if constexpr (SquaresA::kRound) {
      m = {m.main + radius_a * round_a.hessian.main, m.beside + radius_a * round_a.hessian.beside};
    }
    if constexpr (SquaresB::kRound) {
      m = {m.main + radius_b * round_b.hessian.main, m.beside + radius_b * round_b.hessian.beside};
    }
    return m;
  }

  HWY_INLINE void solve_once(PlacedParts& parts, Vec4 x) {
    Symmetric4 m = matrix(parts);
    trace = HWY_NAMESPACE::trace(m);
    const double distance = least * per_square_;
    const bool singular = regularisation_ < kNearlySingular * trace;
    careful_ = singular || regularisation_ != distance;
    lift_ = spread(0.0);
    if (HWY_UNLIKELY(careful_)) {
      lift(m, x, singular && parts.count() > 1 ? trace : regularisation_, distance);
    }
    const Cofactors c = cofactors(m);
    if (parts.count() == 3 && meet_all(parts, x, c)) return;
    if (parts.count() == 2 && meet(parts, x, c)) return;
    set_next(x, c.matrix * (parts.gap[0] + lift_), c);
  }
  // Sets the regularisation along x to `along`, and lift_ to the vector that the gap vector needs
  // in return.
  HWY_INLINE void lift(Symmetric4& m, Vec4 x, double along, double distance) {
    const Vec4 more = spread((along - regularisation_) * per_square_) * x;
    m = {m.main + more * x, m.beside + more * yzx(x)};
    lift_ = (along - distance) * x;
  }
  // `y`: the next direction, times the determinant.
  HWY_INLINE void set_next(Vec4 x, Vec4 y, const Cofactors& c) {
    next = HWY_LIKELY(!careful_) ? y / c.determinant : spread(square / dot(x, y)) * y;
  }
  // The step of two pairs of parts, to the direction at which both distances are equal. False: one
  // pair is left.
  HWY_INLINE bool meet(PlacedParts& parts, Vec4 x, const Cofactors& c) {
    const Vec4 u = parts.gap[1] - parts.gap[0];
    const Vec4 first = c.matrix * (parts.gap[0] + lift_), across = c.matrix * u;
    const double part = -dot(u, first) / dot(u, across);
    if (!(part > 0.0)) {
      parts.drop(1);
      return false;
    }
    if (!(part < 1.0)) {
      parts.drop(0);
      return false;
    }
    parts.weight[0] = 1.0 - part;
    parts.weight[1] = part;
    set_next(x, first + part * across, c);
    return true;
  }
  // The step of three pairs. False: one pair is left, after its step for two.
  bool meet_all(PlacedParts& parts, Vec4 x, const Cofactors& c) {
    const Vec4 u = parts.gap[1] - parts.gap[0], v = parts.gap[2] - parts.gap[0];
    const Vec4 first = c.matrix * (parts.gap[0] + lift_), of_u = c.matrix * u, of_v = c.matrix * v;
    const double uu = dot(u, of_u), uv = dot(u, of_v), vv = dot(v, of_v);
    const double to_u = -dot(u, first), to_v = -dot(v, first), area = uu * vv - uv * uv;
    const double part_u = (to_u * vv - to_v * uv) / area, part_v = (uu * to_v - uv * to_u) / area;
    const double part = 1.0 - part_u - part_v, smallest = std::min({part, part_u, part_v});
    if (!(smallest > 0.0)) {
      parts.drop(smallest == part_u ? 1 : (smallest == part_v ? 2 : 0));
      return meet(parts, x, c);
    }
    parts.weight[0] = part;
    parts.weight[1] = part_u;
    parts.weight[2] = part_v;
    const Vec4 normal = cross(u, v);
    next = (square / dot(normal, x)) * normal;
    return true;
  }

  const SquaresA squares_a_;
  const SquaresB squares_b_;
  double per_square_ = 1.0, regularisation_ = 0.0;
  bool careful_ = false;
  Vec4 lift_{};  // added to the gap vectors
};

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
