// One step of Newton's method on the direction. It evaluates the active parts of two bodies along
// the direction, and finds the direction that makes the least of their distances greatest. Compiled
// once per vector width: see core/numerics/vec4-inl.hpp.
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
// regularisation of K differs from d, w changes along n by the difference. This gives the same
// step. If one of the two curvatures is small as well, as on a rim, the inverse loses the other
// one. The step is then solved on the tangent plane. So are the steps of two and three pairs.
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

  // Adds a pair that is not yet active. A fourth one takes the place of the pair whose weight is
  // the first to vanish as that of the new one grows, as in the simplex method.
  HWY_NOINLINE void add(PlacedParts& parts, const PartPair& pair, Vec4 x) const {
    parts.place_behind(pair);
    std::size_t at = parts.count();
    if (at == 3) {
      set_gap(parts, 3);
      at = first_to_vanish(parts, x);
    }
    parts.add(pair, at);
  }

  Vec4 next;
  RoundSupport round_a, round_b;
  double square = 1.0;  // of x
  double least = 0.0;   // the distance of the nearest pair of parts, times the length of x
  double trace = 0.0;   // of the step's matrix

 private:
  // The distance of a pair of parts, times the length of x.
  HWY_INLINE double evaluate(PlacedParts& parts, Vec4 x, std::size_t i) {
    double value = dot(x, parts.middle[i]);
    if constexpr (SquaresA::kRound) value -= parts.radius_a[i] * round_a.value;
    if constexpr (SquaresB::kRound) value -= parts.radius_b[i] * round_b.value;
    set_gap(parts, i);
    return value;
  }

  HWY_INLINE void set_gap(PlacedParts& parts, std::size_t i) const {
    Vec4 w = parts.middle[i];
    if constexpr (SquaresA::kRound) w = w - parts.radius_a[i] * round_a.point;
    if constexpr (SquaresB::kRound) w = w - parts.radius_b[i] * round_b.point;
    parts.gap[i] = w;
  }
  // Returns the first of the three active pairs whose weight vanishes when the fourth pair enters.
  // The gap vector of the fourth is a sum of theirs with shares of sum 1, up to a multiple of x.
  [[nodiscard]] static std::size_t first_to_vanish(const PlacedParts& parts, Vec4 x) {
    const Vec4 u = parts.gap[1] - parts.gap[0], v = parts.gap[2] - parts.gap[0];
    const Vec4 rest = parts.gap[3] - parts.gap[0];
    const double area = 1.0 / dot(cross(u, v), x);
    const double share_u = dot(x, cross(rest, v)) * area, share_v = dot(x, cross(u, rest)) * area;
    const double share[3] = {1.0 - share_u - share_v, share_u, share_v};
    std::size_t first = 0;
    double least = kInfinity;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!(share[i] > 0.0) || !(parts.weight[i] < least * share[i])) continue;
      least = parts.weight[i] / share[i];
      first = i;
    }
    return first;
  }

  // On the unit sphere, the curvature adds the distance d to the Hessian, which regularises it.
  // While the direction is far from the best one, half the length of the gap vector replaces d.
  HWY_INLINE void set_regularisation(const PlacedParts& parts) {
    regularisation_ = least * per_square_;
    const double gap = nearest_square(parts);
    if (HWY_UNLIKELY(4.0 * least * std::abs(least) < gap * square)) {
      regularisation_ = 0.5 * std::sqrt(gap * per_square_);
    }
  }
  // The square of the distance between points of the active pairs' hulls.
  [[nodiscard]] HWY_INLINE double nearest_square(const PlacedParts& parts) const {
    Vec4 w = parts.gap[0];
    for (std::size_t i = 1; i < parts.count(); ++i) {
      const Vec4 u = parts.gap[i] - w;
      const double part = std::clamp(-dot(u, w) / dot(u, u), 0.0, 1.0);
      w = w + part * u;
    }
    return dot(w, w);
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
    if (HWY_UNLIKELY(parts.count() == 3) && intersect_all(parts, x, m)) return;
    if (HWY_UNLIKELY(parts.count() == 2) && stop_at_kink(parts, x, m)) return;
    const Cofactors c = cofactors(m);
    const double distance = least * per_square_;
    const bool singular = regularisation_ < kNearlySingular * trace;
    if (HWY_LIKELY(!singular && regularisation_ == distance)) {
      next = (c.matrix * parts.gap[0]) / c.determinant;
    } else if (sum3(c.matrix.main) > kNearlySingular * trace * trace) {
      const Vec4 y = c.matrix * (parts.gap[0] + spread(regularisation_ - distance) * x);
      next = spread(square / dot(x, y)) * y;
    } else {
      next = x + tangent_step(parts.gap[0], x, m);
    }
  }
  // The step of one pair of parts on the tangent plane. Its first axis is that of the greater
  // curvature, so that the noise of this curvature stays out of the other axis.
  HWY_INLINE Vec4 tangent_step(Vec4 w, Vec4 x, const Symmetric4& m) const {
    const Vec4 steepest = column_of_greatest(m);
    const Vec4 u = steepest - spread(dot(steepest, x) * per_square_) * x, v = cross(x, u);
    const Vec4 m_u = m * u, m_v = m * v;
    const double uu = dot(u, m_u), uv = dot(u, m_v), vv = dot(v, m_v);
    const double to_u = dot(u, w), to_v = dot(v, w), area = 1.0 / (uu * vv - uv * uv);
    return spread((to_u * vv - to_v * uv) * area) * u + spread((to_v * uu - to_u * uv) * area) * v;
  }
  [[nodiscard]] static HWY_INLINE Vec4 column_of_greatest(const Symmetric4& m) {
    const double x = lane(m.main, 0), y = lane(m.main, 1), z = lane(m.main, 2);
    if (x >= y && x >= z) return m * vec4(1.0, 0.0, 0.0, 0.0);
    return y >= z ? m * vec4(0.0, 1.0, 0.0, 0.0) : m * vec4(0.0, 0.0, 1.0, 0.0);
  }
  // A direction at which two pairs of parts are equally far apart.
  struct Kink {
    Vec4 next;
    double part;  // the weight of the second pair
    [[nodiscard]] HWY_INLINE bool is_between() const { return part > 0.0 && part < 1.0; }
  };
  // The step of two pairs of parts. It is to_kink u + along_kink (x cross u), with u the tangent
  // part of the difference of the gap vectors. The first part makes both distances equal, and the
  // second one is Newton's step along the kink. Nothing here is a small difference of large
  // numbers, so a small distance costs no digits.
  HWY_INLINE Kink kink(const PlacedParts& parts, std::size_t i, std::size_t j, Vec4 x,
                       const Symmetric4& m) const {
    const Vec4 w = parts.gap[i], difference = parts.gap[j] - w;
    const double height = dot(difference, x);
    const Vec4 u = difference - spread(height * per_square_) * x, v = cross(x, u);
    const Vec4 m_u = m * u, m_v = m * v;
    const double per_length = 1.0 / dot(u, u), to_kink = -height * per_length, uv = dot(u, m_v);
    const double along_kink = (dot(v, w) - to_kink * uv) / dot(v, m_v);
    const double part = (to_kink * dot(u, m_u) - dot(u, w)) + along_kink * uv;
    return {x + (spread(to_kink) * u + spread(along_kink) * v), part * per_length};
  }
  HWY_INLINE void keep(PlacedParts& parts, const Kink& kink) {
    parts.weight[0] = 1.0 - kink.part;
    parts.weight[1] = kink.part;
    next = kink.next;
  }
  // False: one pair is left.
  HWY_INLINE bool stop_at_kink(PlacedParts& parts, Vec4 x, const Symmetric4& m) {
    const Kink both = kink(parts, 0, 1, x, m);
    if (!both.is_between()) {
      parts.drop(both.part < 1.0 ? 1 : 0);
      return false;
    }
    keep(parts, both);
    return true;
  }
  // The step of three pairs. False: one pair is left.
  bool intersect_all(PlacedParts& parts, Vec4 x, const Symmetric4& m) {
    const Vec4 u = parts.gap[1] - parts.gap[0], v = parts.gap[2] - parts.gap[0];
    const Vec4 normal = cross(u, v);
    const double area = dot(normal, x);
    next = spread(square / area) * normal;
    const Vec4 rest = m * (next - x) - parts.gap[0];
    const double part_u = dot(x, cross(rest, v)) / area, part_v = dot(x, cross(u, rest)) / area;
    const double part = 1.0 - part_u - part_v, smallest = std::min({part, part_u, part_v});
    if (!(smallest > 0.0)) {
      return drop_one(parts, smallest == part_u ? 1 : (smallest == part_v ? 2 : 0), x, m);
    }
    parts.weight[0] = part;
    parts.weight[1] = part_u;
    parts.weight[2] = part_v;
    return true;
  }
  // Drops the pair that is farther apart than the other two where these stop_at_kink. `first`: the
  // one that is tried first.
  bool drop_one(PlacedParts& parts, std::size_t first, Vec4 x, const Symmetric4& m) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t out = (first + k) % 3, i = out == 0 ? 1 : 0, j = out == 2 ? 1 : 2;
      const Kink both = kink(parts, i, j, x, m);
      if (!both.is_between() || dot(parts.gap[out] - parts.gap[i], both.next) < 0.0) continue;
      parts.drop(out);
      keep(parts, both);
      return true;
    }
    parts.drop(first);
    return stop_at_kink(parts, x, m);
  }

  const SquaresA squares_a_;
  const SquaresB squares_b_;
  double per_square_ = 1.0, regularisation_ = 0.0;
};

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
