// Newton's method on the direction along which two bodies are farthest apart, with the pieces that
// are active there: from the last direction of a tracked pair mostly two steps. Compiled once a
// vector width: see core/numerics/vec4-inl.hpp.
//
// Directions are of any length: for x = l n, the distance along n and radii of curvature are by 1/l
// and 1/l^2 what they are along n, and a step (K + d)^-1 w leads from n to n + s as it is, because
// K n = 0 and w.n = d. So nothing is brought to unit length before the certificate.
#if defined(CLEARANCE_CORE_NEWTON) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_NEWTON
#undef CLEARANCE_CORE_NEWTON
#else
#define CLEARANCE_CORE_NEWTON
#endif

#include <algorithm>
#include <cmath>

#include "core/curved/flat-inl.hpp"
#include "core/curved/own_support-inl.hpp"
#include "core/curved/roundness-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// Looks at a direction, the last one of which certifies; a tracked query takes three.
inline constexpr int kLooks = 12;
// The witness points are along the direction to this, or to rounding.
inline constexpr double kAlong = 0x1p-34;
// A longer step, of a unit direction, may lead to other pieces. By its square.
inline constexpr double kLongStep = 0x1p-10;
// Of bodies that touch nearly: after a step this short the next one is rounding. By its square.
inline constexpr double kFinalStep = 0x1p-52;
// By squares: see kNearAxis.
inline constexpr double kNearAxisSquare = kNearAxis * kNearAxis;

// What a query with certified bounds has found, but for rounding and the radii.
struct NewtonEnd {
  double lower, upper;
  Vec4 normal;             // frame A, unit
  Vec4 on_a, own_b, on_b;  // closest points; own_b: frame B
  int supports = 0;
};

enum class Next { kLook, kTight, kGiveUp };

template <class RoundnessA, class RoundnessB>
class Newton {
 public:
  HWY_INLINE Newton(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                    const RelativePose4& a_from_b, const RoundnessA& round_a,
                    const RoundnessB& round_b, double tolerance, Vec4 x, ActivePieces& active)
      : a_(a),
        b_(b),
        a_from_b_(a_from_b),
        round_a_(round_a),
        round_b_(round_b),
        tolerance_(tolerance),
        x_(x),
        active_(active) {}

  // True: the bounds are tight. `active` is where it ended, whatever came of it.
  HWY_INLINE bool run() {
    Next next = Next::kLook;
    if (HWY_UNLIKELY(has_flat())) {
      next = try_flat();
    } else {
      place_all();
    }
    while (next == Next::kLook && end.supports < kLooks) next = look();
    return next == Next::kTight;
  }

  // For the next query: of about unit length, which takes less time to know than the unit normal.
  [[nodiscard]] HWY_INLINE Vec4 next_start() const {
    const bool nearly_unit = !was_flat_ && std::abs(square_ - 1.0) < 0.25;
    return HWY_LIKELY(nearly_unit) ? (1.5 - 0.5 * square_) * x_ : end.normal;
  }

  NewtonEnd end;

 private:
  // ---- the pieces ----
  [[nodiscard]] HWY_INLINE SidePieces side(bool of_a) const {
    return {active_.pieces.data(), weight_, active_.count, of_a ? &PiecePair::a : &PiecePair::b};
  }
  [[nodiscard]] HWY_INLINE bool has_flat() const {
    const PiecePair& first = active_.pieces[0];
    return first.a >= first_flat(a_) || first.b >= first_flat(b_);
  }
  // A piece's middle in the body's own frame, and its radius.
  struct Piece4 {
    Vec4 middle;
    double radius;
  };
  [[nodiscard]] static HWY_INLINE Piece4 piece(const ConvexPolyhedron& body, std::int32_t number) {
    const auto at = static_cast<std::size_t>(number);
    switch (body.curved.kind) {
      case CurvedShape::Kind::kNone:
        return {load3(body.anchors[at]), 0.0};
      case CurvedShape::Kind::kEllipsoid:
        return {spread(0.0), 1.0};
      case CurvedShape::Kind::kTruncatedCone:
        break;
    }
    const Disc& disc = body.curved.discs[at];
    return {vec4(0.0, 0.0, disc.height, 0.0), disc.radius};
  }
  HWY_INLINE void place(std::size_t i) {
    const Piece4 a = piece(a_, active_.pieces[i].a), b = piece(b_, active_.pieces[i].b);
    middle_[i] = point_to_a(a_from_b_, b.middle) - a.middle;
    radius_a_[i] = a.radius;
    radius_b_[i] = b.radius;
  }
  HWY_INLINE void place_all() {
    place(0);
    weight_[0] = 1.0;
    if (HWY_LIKELY(active_.count == 1)) return;
    weight_[0] = 1.0 / static_cast<double>(active_.count);
    for (std::size_t i = 1; i < active_.count; ++i) {
      place(i);
      weight_[i] = weight_[0];
    }
  }
  void drop(std::size_t at) {
    --active_.count;
    for (std::size_t i = at; i < active_.count; ++i) {
      active_.pieces[i] = active_.pieces[i + 1];
      middle_[i] = middle_[i + 1];
      radius_a_[i] = radius_a_[i + 1];
      radius_b_[i] = radius_b_[i + 1];
      apart_[i] = apart_[i + 1];
    }
    if (active_.count == 1) weight_[0] = 1.0;
  }
  // kNone: of this body, that of the heaviest pair.
  void add(std::int32_t of_a, std::int32_t of_b) {
    std::size_t most = 0, least = 0;
    for (std::size_t i = 1; i < active_.count; ++i) {
      if (weight_[i] > weight_[most]) most = i;
      if (weight_[i] < weight_[least]) least = i;
    }
    PiecePair pieces = active_.pieces[most];
    if (of_a != kNone) pieces.a = of_a;
    if (of_b != kNone) pieces.b = of_b;
    const std::size_t at = active_.count < 3 ? active_.count++ : least;
    active_.pieces[at] = pieces;
    weight_[at] = 0.0;
    place(at);
  }

  // ---- one direction ----
  HWY_INLINE Next look() {
    ++end.supports;
    see();
    if (HWY_UNLIKELY(is_near_axis())) return try_cap(x_);
    set_shift();
    solve();
    const Vec4 step = next_ - x_;
    const double square = dot(step, step);
    if (HWY_UNLIKELY(!(square < kInfinity))) return Next::kGiveUp;
    if (HWY_UNLIKELY(passes_axis())) {
      if (!cap_tried_) return try_cap(next_);
      stop_before_axis(step);
      return Next::kLook;
    }
    x_ = next_;
    // The next step would be about the square of this one.
    if (square * trace_ <= kAlong * least_ || square <= kFinalStep * square_) return certify();
    if (square > kLongStep * square_) grow();
    return Next::kLook;
  }

  HWY_INLINE void see() {
    square_ = dot(x_, x_);
    if constexpr (RoundnessA::kRound) seen_a_ = view(round_a_, x_);
    if constexpr (RoundnessB::kRound) seen_b_ = view(round_b_, x_);
    per_square_ = 1.0 / square_;
    least_ = see(0);
    for (std::size_t i = 1; i < active_.count; ++i) least_ = std::min(least_, see(i));
  }
  // How far apart a pair of pieces is, times the length of x_.
  HWY_INLINE double see(std::size_t i) {
    Vec4 w = middle_[i];
    double value = dot(x_, w);
    if constexpr (RoundnessA::kRound) {
      w = w - radius_a_[i] * seen_a_.out;
      value -= radius_a_[i] * seen_a_.reach;
    }
    if constexpr (RoundnessB::kRound) {
      w = w - radius_b_[i] * seen_b_.out;
      value -= radius_b_[i] * seen_b_.reach;
    }
    apart_[i] = w;
    return value;
  }

  // The sphere's own curvature: how far apart the bodies are, or of one pair of pieces nearly so as
  // long as the direction is far off.
  HWY_INLINE void set_shift() {
    shift_ = least_ * per_square_;
    const double farthest = dot(apart_[0], apart_[0]);
    const bool far_off =
        active_.count == 1 ? 4.0 * least_ * std::abs(least_) < farthest * square_ : !(least_ > 0.0);
    if (HWY_UNLIKELY(far_off)) shift_ = 0.5 * std::sqrt(farthest * per_square_);
  }

  [[nodiscard]] HWY_INLINE Symmetric4 hessian() const {
    Symmetric4 m{spread(shift_), spread(0.0)};
    double of_a = radius_a_[0], of_b = radius_b_[0];
    if (active_.count > 1) {
      of_a = of_b = 0.0;
      for (std::size_t i = 0; i < active_.count; ++i) {
        of_a += weight_[i] * radius_a_[i];
        of_b += weight_[i] * radius_b_[i];
      }
    }
    if constexpr (RoundnessA::kRound) {
      m = {m.main + of_a * seen_a_.turn.main, m.beside + of_a * seen_a_.turn.beside};
    }
    if constexpr (RoundnessB::kRound) {
      m = {m.main + of_b * seen_b_.turn.main, m.beside + of_b * seen_b_.turn.beside};
    }
    return m;
  }

  // To next_; the pieces' weights there. Which pieces' curvature counts is what the weights say, so
  // that they are found twice where it is not the same.
  HWY_INLINE void solve() {
    solve_once();
    if (HWY_LIKELY(active_.count == 1)) return;
    const bool same = radius_a_[0] == radius_a_[1] && radius_b_[0] == radius_b_[1];
    if (!same) solve_once();
  }
  HWY_INLINE void solve_once() {
    const Symmetric4 m = hessian();
    trace_ = trace(m);
    const Cofactors c = cofactors(m);
    if (HWY_LIKELY(active_.count == 1)) {
      next_ = (c.matrix * apart_[0]) / c.determinant;
      return;
    }
    if (active_.count == 3 && meet_all(c)) return;
    if (active_.count == 2 && meet(c)) return;
    next_ = (c.matrix * apart_[0]) / c.determinant;
  }
  // Of two: to where both are equal. False: one of them is left.
  HWY_INLINE bool meet(const Cofactors& c) {
    const Vec4 between = apart_[1] - apart_[0];
    const Vec4 own = c.matrix * apart_[0], across = c.matrix * between;
    const double part = -dot(between, own) / dot(between, across);
    if (!(part > 0.0)) {
      drop(1);
      return false;
    }
    if (!(part < 1.0)) {
      drop(0);
      return false;
    }
    weight_[0] = 1.0 - part;
    weight_[1] = part;
    next_ = (own + part * across) / c.determinant;
    return true;
  }
  // Of three. False: two of them are left, and what comes of these is done.
  bool meet_all(const Cofactors& c) {
    const Vec4 u = apart_[1] - apart_[0], v = apart_[2] - apart_[0];
    const Vec4 own = c.matrix * apart_[0], of_u = c.matrix * u, of_v = c.matrix * v;
    const double uu = dot(u, of_u), uv = dot(u, of_v), vv = dot(v, of_v);
    const double to_u = -dot(u, own), to_v = -dot(v, own), area = uu * vv - uv * uv;
    const double part_u = (to_u * vv - to_v * uv) / area, part_v = (uu * to_v - uv * to_u) / area;
    const double part = 1.0 - part_u - part_v, least = std::min({part, part_u, part_v});
    if (!(least > 0.0)) {
      drop(least == part_u ? 1 : (least == part_v ? 2 : 0));
      return meet(c);
    }
    weight_[0] = part;
    weight_[1] = part_u;
    weight_[2] = part_v;
    const Vec4 normal = cross(u, v);
    next_ = (square_ / dot(normal, x_)) * normal;
    return true;
  }

  // Pieces that are farther out along a direction that is still on its way.
  HWY_NOINLINE void grow() {
    const Vec4 n = over(x_, norm(x_));
    const OwnSupport a = own_support(a_, side(true), n);
    const OwnSupport b = own_support(b_, side(false), -direction_to_b(a_from_b_, n));
    if (a.missing != kNone || b.missing != kNone) add(a.missing, b.missing);
  }

  HWY_INLINE Next certify() {
    const Vec4 n = over(x_, norm(x_));
    const OwnSupport a = own_support(a_, side(true), n);
    const OwnSupport b = own_support(b_, side(false), -direction_to_b(a_from_b_, n));
    if (HWY_UNLIKELY(!a.known || !b.known)) return try_cap(x_);
    const Vec4 on_b = point_to_a(a_from_b_, b.point), difference = on_b - a.point;
    end.lower = (dot(n, a_from_b_.translation) - a.reach) - b.reach;
    end.upper = norm(difference);
    end.normal = n;
    end.on_a = a.point;
    end.own_b = b.point;
    end.on_b = on_b;
    const bool complete =
        (a.missing == kNone || a_.is_curved()) && (b.missing == kNone || b_.is_curved());
    if (HWY_LIKELY(complete && end.upper - end.lower <= tolerance_)) {
      const Vec4 across = difference - spread(dot(n, difference)) * n;
      const double limit = std::max(4.0 * kAlong * end.upper, 8.0 * tolerance_);
      if (HWY_LIKELY(dot(across, across) <= limit * limit)) {
        if (HWY_UNLIKELY(active_.count == 3)) to_facet();
        return Next::kTight;
      }
    }
    if (a.missing != kNone || b.missing != kNone) add(a.missing, b.missing);
    return Next::kLook;
  }

  // ---- flats ----
  template <class Roundness>
  [[nodiscard]] static HWY_INLINE bool is_cone(const ConvexPolyhedron& body) {
    return Roundness::kRound && body.curved.kind == CurvedShape::Kind::kTruncatedCone;
  }
  [[nodiscard]] HWY_INLINE bool is_near_axis() const {
    const double least = kNearAxisSquare * square_;
    return (is_cone<RoundnessA>(a_) && !(seen_a_.square > least)) ||
           (is_cone<RoundnessB>(b_) && !(seen_b_.square > least));
  }
  // Beyond an axis the rim jumps to the other side: the cap may be what is closest.
  [[nodiscard]] HWY_INLINE bool passes_axis() const {
    return (is_cone<RoundnessA>(a_) && dot(seen_a_.squared, next_) <= 0.0) ||
           (is_cone<RoundnessB>(b_) && dot(seen_b_.squared, next_) <= 0.0);
  }
  void stop_before_axis(Vec4 step) {
    double part = 1.0;
    const auto look = [&](bool cone, const RoundView& seen) HWY_ATTR {
      const double along = -dot(seen.squared, step);
      if (cone && along > 0.0) part = std::min(part, 0.5 * seen.square / along);
    };
    look(is_cone<RoundnessA>(a_), seen_a_);
    look(is_cone<RoundnessB>(b_), seen_b_);
    x_ = x_ + part * step;
  }
  // Of the cone whose axis is nearer to x; once a query.
  HWY_NOINLINE Next try_cap(Vec4 x) {
    if (cap_tried_) return Next::kGiveUp;
    cap_tried_ = true;
    const Vec4 m = -direction_to_b(a_from_b_, x);
    const auto across = [](Vec4 v)
                            HWY_ATTR { return lane(v, 0) * lane(v, 0) + lane(v, 1) * lane(v, 1); };
    const bool a = is_cone<RoundnessA>(a_), b = is_cone<RoundnessB>(b_);
    const bool of_a = a && (!b || across(x) <= across(m));
    const std::int32_t cap = lane(of_a ? x : m, 2) > 0.0 ? 3 : 2;
    PiecePair& pieces = active_.pieces[0];
    active_.count = 1;
    (of_a ? pieces.a : pieces.b) = cap;
    return try_flat();
  }
  HWY_INLINE Next try_flat() {
    ++end.supports;
    return active_.pieces[0].a >= first_flat(a_) ? try_flat_of<true>() : try_flat_of<false>();
  }
  template <bool kOfA>
  HWY_INLINE Next try_flat_of() {
    const ConvexPolyhedron &body = kOfA ? a_ : b_, &other = kOfA ? b_ : a_;
    PiecePair& pieces = active_.pieces[0];
    std::int32_t &flat = kOfA ? pieces.a : pieces.b, &piece = kOfA ? pieces.b : pieces.a;
    active_.count = 1;
    const FlatMeeting met = meet_flat<kOfA>(body, other, a_from_b_, flat, piece);
    if (HWY_UNLIKELY(met.end == FlatEnd::kUnknown)) return Next::kGiveUp;
    piece = met.piece;
    const Vec4 normal = flat_of(body, flat).normal;
    end.normal = kOfA ? normal : -direction_to_a(a_from_b_, normal);
    if (HWY_UNLIKELY(met.end == FlatEnd::kBeside)) {
      leave_flat<kOfA>(met);
      return Next::kLook;
    }
    was_flat_ = true;
    end.lower = met.lower;
    end.upper = met.upper;
    end.on_a = kOfA ? met.below : met.own;
    end.own_b = kOfA ? met.own : met.below;
    end.on_b = point_to_a(a_from_b_, end.own_b);
    return end.upper - end.lower <= tolerance_ ? Next::kTight : Next::kGiveUp;
  }
  // To the edge or the rim beside which the nearest point is.
  template <bool kOfA>
  HWY_NOINLINE void leave_flat(const FlatMeeting& met) {
    const ConvexPolyhedron& body = kOfA ? a_ : b_;
    std::int32_t& flat = kOfA ? active_.pieces[0].a : active_.pieces[0].b;
    if (body.is_curved()) {
      flat -= first_flat(body);
      const Disc& disc = body.curved.discs[static_cast<std::size_t>(flat)];
      const double x = lane(met.below, 0), y = lane(met.below, 1);
      const double part = disc.radius / std::sqrt(x * x + y * y);
      const Vec4 out = met.above - vec4(part * x, part * y, disc.height, 0.0);
      x_ = kOfA ? out : -direction_to_a(a_from_b_, out);
      cap_tried_ = true;
    } else {
      const Edge& edge = body.edges[static_cast<std::size_t>(met.edge)];
      active_.count = 2;
      active_.pieces[1] = active_.pieces[0];
      flat = edge.vertex[0];
      (kOfA ? active_.pieces[1].a : active_.pieces[1].b) = edge.vertex[1];
      x_ = end.normal;
    }
    place_all();
  }
  // Three vertices of a facet are its flat.
  HWY_NOINLINE void to_facet() {
    const bool of_a = !RoundnessA::kRound;
    if (of_a == !RoundnessB::kRound) return;
    const ConvexPolyhedron& body = of_a ? a_ : b_;
    const SidePieces other = side(!of_a);
    if (other.number(0) != other.number(1) || other.number(0) != other.number(2)) return;
    const std::int32_t facet = facet_of(body, side(of_a));
    if (facet == kNone) return;
    active_.count = 1;
    (of_a ? active_.pieces[0].a : active_.pieces[0].b) = facet;
  }

  const ConvexPolyhedron &a_, &b_;
  const RelativePose4& a_from_b_;
  const RoundnessA round_a_;
  const RoundnessB round_b_;
  const double tolerance_;
  Vec4 x_, next_;
  ActivePieces& active_;
  Vec4 middle_[3], apart_[3];
  double radius_a_[3], radius_b_[3], weight_[3];
  RoundView seen_a_, seen_b_;
  double square_ = 1.0, per_square_ = 1.0, least_ = 0.0, shift_ = 0.0, trace_ = 0.0;
  bool cap_tried_ = false, was_flat_ = false;
};

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
