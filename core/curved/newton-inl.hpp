// Newton's method on the direction along which two bodies are farthest apart, with the pieces that
// are active there: from the last direction of a tracked pair mostly two steps. Compiled once a
// vector width: see core/numerics/vec4-inl.hpp.
#if defined(CLEARANCE_CORE_NEWTON) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_NEWTON
#undef CLEARANCE_CORE_NEWTON
#else
#define CLEARANCE_CORE_NEWTON
#endif

#include <algorithm>
#include <cmath>

#include "core/curved/flat-inl.hpp"
#include "core/curved/newton_step-inl.hpp"
#include "core/curved/own_support-inl.hpp"

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
  HWY_INLINE Newton(const ConvexBody& a, const ConvexBody& b, const RelativePose4& a_from_b,
                    const RoundnessA& round_a, const RoundnessB& round_b, double tolerance, Vec4 x,
                    ActivePieces& active)
      : a_(a),
        b_(b),
        a_from_b_(a_from_b),
        tolerance_(tolerance),
        x_(x),
        active_(active),
        pieces_(a, b, a_from_b, active),
        step_(round_a, round_b) {}

  // True: the bounds are tight. `active` is where it ended, whatever came of it.
  HWY_INLINE bool run() {
    Next next = Next::kLook;
    if (HWY_UNLIKELY(pieces_.has_flat())) {
      next = try_flat();
    } else {
      pieces_.place_all();
    }
    while (next == Next::kLook && end.supports < kLooks) next = look();
    return next == Next::kTight;
  }

  // For the next query: of about unit length, which takes less time to know than the unit normal.
  [[nodiscard]] HWY_INLINE Vec4 next_start() const {
    const bool nearly_unit = !was_flat_ && std::abs(step_.square - 1.0) < 0.25;
    return HWY_LIKELY(nearly_unit) ? (1.5 - 0.5 * step_.square) * x_ : end.normal;
  }

  NewtonEnd end;

 private:
  // ---- one direction ----
  HWY_INLINE Next look() {
    ++end.supports;
    step_.see(pieces_, x_);
    if (HWY_UNLIKELY(is_near_axis())) return try_cap(x_);
    step_.solve(pieces_, x_);
    const Vec4 step = step_.next - x_;
    const double square = dot(step, step);
    if (HWY_UNLIKELY(!(square < kInfinity))) return Next::kGiveUp;
    if (HWY_UNLIKELY(passes_axis())) {
      if (!cap_tried_) return try_cap(step_.next);
      stop_before_axis(step);
      return Next::kLook;
    }
    x_ = step_.next;
    // The next step would be about the square of this one.
    if (square * step_.trace <= kAlong * step_.least || square <= kFinalStep * step_.square) {
      return certify();
    }
    if (square > kLongStep * step_.square) grow();
    return Next::kLook;
  }

  // Pieces that are farther out along a direction that is still on its way.
  HWY_NOINLINE void grow() {
    const Vec4 n = over(x_, norm(x_));
    const OwnSupport a = own_support(a_, pieces_.side(true), n);
    const OwnSupport b = own_support(b_, pieces_.side(false), -direction_to_b(a_from_b_, n));
    if (a.missing != kNone || b.missing != kNone) pieces_.add(a.missing, b.missing);
  }

  HWY_INLINE Next certify() {
    const Vec4 n = over(x_, norm(x_));
    const OwnSupport a = own_support(a_, pieces_.side(true), n);
    const OwnSupport b = own_support(b_, pieces_.side(false), -direction_to_b(a_from_b_, n));
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
    if (a.missing != kNone || b.missing != kNone) pieces_.add(a.missing, b.missing);
    return Next::kLook;
  }

  // ---- flats ----
  template <class Roundness>
  [[nodiscard]] static HWY_INLINE bool is_cone(const ConvexBody& body) {
    return Roundness::kRound && body.curved.kind == CurvedShape::Kind::kTruncatedCone;
  }
  [[nodiscard]] HWY_INLINE bool is_near_axis() const {
    const double least = kNearAxisSquare * step_.square;
    return (is_cone<RoundnessA>(a_) && !(step_.seen_a.square > least)) ||
           (is_cone<RoundnessB>(b_) && !(step_.seen_b.square > least));
  }
  // Beyond an axis the rim jumps to the other side: the cap may be what is closest.
  [[nodiscard]] HWY_INLINE bool passes_axis() const {
    return (is_cone<RoundnessA>(a_) && dot(step_.seen_a.squared, step_.next) <= 0.0) ||
           (is_cone<RoundnessB>(b_) && dot(step_.seen_b.squared, step_.next) <= 0.0);
  }
  void stop_before_axis(Vec4 step) {
    double part = 1.0;
    const auto look = [&](bool cone, const RoundView& seen) HWY_ATTR {
      const double along = -dot(seen.squared, step);
      if (cone && along > 0.0) part = std::min(part, 0.5 * seen.square / along);
    };
    look(is_cone<RoundnessA>(a_), step_.seen_a);
    look(is_cone<RoundnessB>(b_), step_.seen_b);
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
    const ConvexBody &body = kOfA ? a_ : b_, &other = kOfA ? b_ : a_;
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
    const ConvexBody& body = kOfA ? a_ : b_;
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
    pieces_.place_all();
  }
  // Three vertices of a facet are its flat.
  HWY_NOINLINE void to_facet() {
    const bool of_a = !RoundnessA::kRound;
    if (of_a == !RoundnessB::kRound) return;
    const ConvexBody& body = of_a ? a_ : b_;
    const SidePieces other = pieces_.side(!of_a);
    if (other.number(0) != other.number(1) || other.number(0) != other.number(2)) return;
    const std::int32_t facet = facet_of(body, pieces_.side(of_a));
    if (facet == kNone) return;
    active_.count = 1;
    (of_a ? active_.pieces[0].a : active_.pieces[0].b) = facet;
  }

  const ConvexBody &a_, &b_;
  const RelativePose4& a_from_b_;
  const double tolerance_;
  Vec4 x_;
  ActivePieces& active_;
  PlacedPieces pieces_;
  NewtonStep<RoundnessA, RoundnessB> step_;
  bool cap_tried_ = false, was_flat_ = false;
};

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
