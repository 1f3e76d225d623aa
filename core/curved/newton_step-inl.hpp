// One step of Newton's method on the direction: what the active pieces of two bodies look like
// along it, and the direction along which the nearest of them is farthest. Compiled once a vector
// width: see core/numerics/vec4-inl.hpp.
//
// Directions are of any length: for x = l n, the distance along n and radii of curvature are by 1/l
// and 1/l^2 what they are along n, and a step (K + d)^-1 w leads from n to n + s as it is, because
// K n = 0 and w.n = d. So nothing is brought to unit length before the certificate.
//
// Of bodies that touch nearly, K + d is all but singular along n: its determinant is what rounding
// leaves. There it is not used, but what is known of the step: that it is across x. And where K is
// shifted by anything but d, along n or across it, w is lifted along n by the difference, which
// comes to the same step.
#if defined(CLEARANCE_CORE_NEWTON_STEP) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_NEWTON_STEP
#undef CLEARANCE_CORE_NEWTON_STEP
#else
#define CLEARANCE_CORE_NEWTON_STEP
#endif

#include <algorithm>
#include <cmath>

#include "core/curved/placed_pieces-inl.hpp"
#include "core/curved/roundness-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// Bodies whose distance is less than this share of their curvature touch nearly: the determinant
// has lost ten bits, and several pieces would have weights that are rounding.
inline constexpr double kNearlySingular = 0x1p-10;

template <class RoundnessA, class RoundnessB>
class NewtonStep {
 public:
  HWY_INLINE NewtonStep(const RoundnessA& a, const RoundnessB& b) : round_a_(a), round_b_(b) {}

  // The pieces along x; `least` and the views hold from here on.
  HWY_INLINE void see(PlacedPieces& pieces, Vec4 x) {
    square = dot(x, x);
    if constexpr (RoundnessA::kRound) seen_a = view(round_a_, x);
    if constexpr (RoundnessB::kRound) seen_b = view(round_b_, x);
    per_square_ = 1.0 / square;
    least = see(pieces, x, 0);
    for (std::size_t i = 1; i < pieces.count(); ++i) least = std::min(least, see(pieces, x, i));
  }

  // From x, which see() has looked along, to `next`; the pieces' weights there. A piece that counts
  // for nothing there is dropped. Which pieces' curvature counts is what the weights say, so that
  // they are found twice where it is not the same.
  HWY_INLINE void solve(PlacedPieces& pieces, Vec4 x) {
    set_shift(pieces);
    solve_once(pieces, x);
    if (HWY_LIKELY(pieces.count() == 1)) return;
    const bool same = pieces.radius_a[0] == pieces.radius_a[1] &&  //
                      pieces.radius_b[0] == pieces.radius_b[1];
    if (!same) solve_once(pieces, x);
  }

  Vec4 next;
  RoundView seen_a, seen_b;
  double square = 1.0;  // of x
  double least = 0.0;   // how far apart the nearest pair of pieces is, times the length of x
  double trace = 0.0;   // of the step's matrix

 private:
  // How far apart a pair of pieces is, times the length of x.
  HWY_INLINE double see(PlacedPieces& pieces, Vec4 x, std::size_t i) {
    Vec4 w = pieces.middle[i];
    double value = dot(x, w);
    if constexpr (RoundnessA::kRound) {
      w = w - pieces.radius_a[i] * seen_a.out;
      value -= pieces.radius_a[i] * seen_a.reach;
    }
    if constexpr (RoundnessB::kRound) {
      w = w - pieces.radius_b[i] * seen_b.out;
      value -= pieces.radius_b[i] * seen_b.reach;
    }
    pieces.apart[i] = w;
    return value;
  }

  // The sphere's own curvature: how far apart the bodies are, or of one pair of pieces nearly so as
  // long as the direction is far off.
  HWY_INLINE void set_shift(const PlacedPieces& pieces) {
    shift_ = least * per_square_;
    const double farthest = dot(pieces.apart[0], pieces.apart[0]);
    const bool far_off =
        pieces.count() == 1 ? 4.0 * least * std::abs(least) < farthest * square : !(least > 0.0);
    if (HWY_UNLIKELY(far_off)) shift_ = 0.5 * std::sqrt(farthest * per_square_);
  }

  [[nodiscard]] HWY_INLINE Symmetric4 hessian(const PlacedPieces& pieces) const {
    Symmetric4 m{spread(shift_), spread(0.0)};
    double of_a = pieces.radius_a[0], of_b = pieces.radius_b[0];
    if (pieces.count() > 1) {
      of_a = of_b = 0.0;
      for (std::size_t i = 0; i < pieces.count(); ++i) {
        of_a += pieces.weight[i] * pieces.radius_a[i];
        of_b += pieces.weight[i] * pieces.radius_b[i];
      }
    }
    if constexpr (RoundnessA::kRound) {
      m = {m.main + of_a * seen_a.turn.main, m.beside + of_a * seen_a.turn.beside};
    }
    if constexpr (RoundnessB::kRound) {
      m = {m.main + of_b * seen_b.turn.main, m.beside + of_b * seen_b.turn.beside};
    }
    return m;
  }

  HWY_INLINE void solve_once(PlacedPieces& pieces, Vec4 x) {
    Symmetric4 m = hessian(pieces);
    trace = HWY_NAMESPACE::trace(m);
    const double apart = least * per_square_;
    const bool singular = shift_ < kNearlySingular * trace;
    careful_ = singular || shift_ != apart;
    lift_ = spread(0.0);
    if (HWY_UNLIKELY(careful_)) {
      lift(m, x, singular && pieces.count() > 1 ? trace : shift_, apart);
    }
    const Cofactors c = cofactors(m);
    if (pieces.count() == 3 && meet_all(pieces, x, c)) return;
    if (pieces.count() == 2 && meet(pieces, x, c)) return;
    set_next(x, c.matrix * (pieces.apart[0] + lift_), c);
  }
  // The shift along x becomes `along`.
  HWY_INLINE void lift(Symmetric4& m, Vec4 x, double along, double apart) {
    const Vec4 more = spread((along - shift_) * per_square_) * x;
    m = {m.main + more * x, m.beside + more * yzx(x)};
    lift_ = (along - apart) * x;
  }
  // `y`: the step's end, times the determinant.
  HWY_INLINE void set_next(Vec4 x, Vec4 y, const Cofactors& c) {
    next = HWY_LIKELY(!careful_) ? y / c.determinant : spread(square / dot(x, y)) * y;
  }
  // Of two: to where both are equal. False: one of them is left.
  HWY_INLINE bool meet(PlacedPieces& pieces, Vec4 x, const Cofactors& c) {
    const Vec4 between = pieces.apart[1] - pieces.apart[0];
    const Vec4 own = c.matrix * (pieces.apart[0] + lift_), across = c.matrix * between;
    const double part = -dot(between, own) / dot(between, across);
    if (!(part > 0.0)) {
      pieces.drop(1);
      return false;
    }
    if (!(part < 1.0)) {
      pieces.drop(0);
      return false;
    }
    pieces.weight[0] = 1.0 - part;
    pieces.weight[1] = part;
    set_next(x, own + part * across, c);
    return true;
  }
  // Of three. False: two of them are left, and what comes of these is done.
  bool meet_all(PlacedPieces& pieces, Vec4 x, const Cofactors& c) {
    const Vec4 u = pieces.apart[1] - pieces.apart[0], v = pieces.apart[2] - pieces.apart[0];
    const Vec4 own = c.matrix * (pieces.apart[0] + lift_), of_u = c.matrix * u, of_v = c.matrix * v;
    const double uu = dot(u, of_u), uv = dot(u, of_v), vv = dot(v, of_v);
    const double to_u = -dot(u, own), to_v = -dot(v, own), area = uu * vv - uv * uv;
    const double part_u = (to_u * vv - to_v * uv) / area, part_v = (uu * to_v - uv * to_u) / area;
    const double part = 1.0 - part_u - part_v, smallest = std::min({part, part_u, part_v});
    if (!(smallest > 0.0)) {
      pieces.drop(smallest == part_u ? 1 : (smallest == part_v ? 2 : 0));
      return meet(pieces, x, c);
    }
    pieces.weight[0] = part;
    pieces.weight[1] = part_u;
    pieces.weight[2] = part_v;
    const Vec4 normal = cross(u, v);
    next = (square / dot(normal, x)) * normal;
    return true;
  }

  const RoundnessA round_a_;
  const RoundnessB round_b_;
  double per_square_ = 1.0, shift_ = 0.0;
  bool careful_ = false;
  Vec4 lift_{};  // of `apart`
};

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
