// Newton's method on the direction along which the distance of two bodies is greatest, with the
// parts that are active there: the fast effort. For a tracked pair it starts from the last
// direction and mostly takes two steps. Compiled once per vector width: see
// core/numerics/vec4-inl.hpp.
#if defined(CLEARANCE_CORE_NEWTON) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_NEWTON
#undef CLEARANCE_CORE_NEWTON
#else
#define CLEARANCE_CORE_NEWTON
#endif

#include <algorithm>
#include <cmath>

#include "core/curved/newton_step-inl.hpp"
#include "core/curved/planar_face-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// The limit on evaluated directions, planar faces among them; a tracked query takes three. Two
// ellipsoids that take more than twelve are thin, and mostly take many more.
inline constexpr int kIterations = 16, kIterationsOfEllipsoids = 12;
// The gap vector of the witness points is parallel to the direction within this, or within
// rounding.
inline constexpr double kAlong = 0x1p-34;
// After a longer step of a unit direction, other parts may have become active. The limit is for the
// square of the step.
inline constexpr double kLongStep = 0x1p-10;
// If bodies nearly touch, the next step after one this short is rounding. The limit is for the
// square of the step.
inline constexpr double kFinalStep = 0x1p-52;
// An overlap along the best direction by more tolerances than this is certain, whatever rounding
// does.
inline constexpr double kOverlap = 0x1p20;
inline constexpr double kNearAxisSquare = kNearAxis * kNearAxis;

// Bounds and their witness points. They do not yet account for rounding errors or for the radii of
// the bodies.
struct NewtonEnd {
  double lower, upper;
  Vec4 normal;              // frame A, unit
  Vec4 on_a, on_b_B, on_b;  // closest points; on_b_B: frame B
  int supports = 0;
  bool overlap = false;  // the bodies overlap along `normal`, and no small rotation changes that
};

// Two planar faces are tried one after the other if the cosine of the angle between them exceeds
// this.
inline constexpr double kFacing = 0x1.fep-1;

enum class Next { kIterate, kCertified, kGiveUp, kOtherFace };

template <class SquaresA, class SquaresB>
class Newton {
 public:
  HWY_INLINE Newton(const Side& a, const Side& b, const RelativePose4& a_from_b,
                    const SquaresA& squares_a, const SquaresB& squares_b, double tolerance, Vec4 x,
                    bool ends_at_overlap, ActiveParts& active)
      : a_(a),
        b_(b),
        a_from_b_(a_from_b),
        tolerance_(tolerance),
        x_(x),
        ends_at_overlap_(ends_at_overlap),
        active_(active),
        parts_(a, b, a_from_b, active),
        step_(squares_a, squares_b) {}

  // True: the bounds have converged. `active` holds the last active parts in either case.
  HWY_INLINE bool run() {
    Next next = Next::kIterate;
    if (HWY_UNLIKELY(parts_.has_planar_face())) {
      next = try_face();
    } else {
      parts_.place_all();
    }
    const int limit = are_ellipsoids() ? kIterationsOfEllipsoids : kIterations;
    while (next == Next::kIterate && end.supports < limit) next = iterate();
    return next == Next::kCertified;
  }

  // The first direction of the next query. It has about unit length and is known sooner than the
  // unit normal.
  [[nodiscard]] HWY_INLINE Vec4 next_start() const {
    const bool nearly_unit = !ended_on_face_ && std::abs(step_.square - 1.0) < 0.25;
    return HWY_LIKELY(nearly_unit) ? (1.5 - 0.5 * step_.square) * x_ : end.normal;
  }

  NewtonEnd end;

 private:
  // Ellipsoids have no other parts that could become active, and long steps do them no harm.
  [[nodiscard]] HWY_INLINE bool are_ellipsoids() const {
    return a_.round.count == 1 && b_.round.count == 1;
  }

  // ---- one direction ----
  HWY_INLINE Next iterate() {
    ++end.supports;
    step_.evaluate(parts_, x_);
    if (HWY_UNLIKELY(is_near_axis())) return try_cap(x_);
    step_.solve(parts_, x_);
    const Vec4 step = step_.next - x_;
    const double square = dot(step, step);
    if (HWY_UNLIKELY(!(square < kInfinity))) return Next::kGiveUp;
    if (HWY_UNLIKELY(passes_axis())) {
      if (!cap_tried_) return try_cap(step_.next);
      if (!stopped_) {
        stopped_ = true;
        stop_before_axis(step);
        grow();
        return Next::kIterate;
      }
    }
    x_ = step_.next;
    // Convergence is quadratic: the next step would be about the square of this one.
    if (square * step_.trace <= kAlong * step_.least || square <= kFinalStep * step_.square) {
      return certify();
    }
    if (square > kLongStep * step_.square) {
      if (are_ellipsoids()) return Next::kIterate;
      if (HWY_UNLIKELY(square > step_.square)) {
        x_ = x_ - spread(1.0 - std::sqrt(step_.square / square)) * step;
      }
      grow();
    }
    return Next::kIterate;
  }

  // Adds the pair of parts that is nearest along a direction that is not yet the best. Returns its
  // distance, m.
  HWY_NOINLINE double grow() {
    const Vec4 n = over(x_, norm(x_));
    const SupportPart a = support_part(a_, parts_.side(true), n);
    const SupportPart b = support_part(b_, parts_.side(false), -direction_to_b(a_from_b_, n));
    add({a.number, b.number});
    return (dot(n, a_from_b_.translation) - a.value) - b.value;
  }

  // A pair that is active already stays as it is.
  HWY_INLINE void add(const PartPair& pair) {
    if (pair.a == kNone || pair.b == kNone) return;  // the direction is not finite
    if (!parts_.has(pair)) step_.add(parts_, pair, x_);
  }

  HWY_INLINE Next certify() {
    const Vec4 n = over(x_, norm(x_));
    const BodySupport a = body_support(a_, parts_.side(true), n);
    const BodySupport b = body_support(b_, parts_.side(false), -direction_to_b(a_from_b_, n));
    if (HWY_UNLIKELY(!a.known || !b.known)) return try_cap(x_);
    const Vec4 on_b = point_to_a(a_from_b_, b.point), gap = on_b - a.point;
    end.lower = (dot(n, a_from_b_.translation) - a.value) - b.value;
    end.upper = norm(gap);
    end.normal = n;
    end.on_a = a.point;
    end.on_b_B = b.point;
    end.on_b = on_b;
    if (HWY_LIKELY(end.upper - end.lower <= tolerance_)) {
      const Vec4 across = gap - spread(dot(n, gap)) * n;
      const double limit = std::max(4.0 * kAlong * end.upper, 8.0 * tolerance_);
      if (HWY_LIKELY(dot(across, across) <= limit * limit)) {
        if (HWY_UNLIKELY(active_.count == 3)) to_facet();
        return Next::kCertified;
      }
    }
    if (dot(n, gap) - end.lower > tolerance_) {
      add({a.part, b.part});
      return Next::kIterate;
    }
    end.overlap = ends_at_overlap_ && end.lower < -kOverlap * tolerance_;
    // Rounding alone otherwise keeps the bounds apart.
    return end.overlap ? Next::kGiveUp : Next::kIterate;
  }

  // ---- planar faces ----
  [[nodiscard]] HWY_INLINE bool caps_of_a() const { return SquaresA::kRound && a_.round.has_caps; }
  [[nodiscard]] HWY_INLINE bool caps_of_b() const { return SquaresB::kRound && b_.round.has_caps; }
  [[nodiscard]] HWY_INLINE bool is_near_axis() const {
    const double least = kNearAxisSquare * step_.square;
    return (caps_of_a() && !(step_.round_a.square > least)) ||
           (caps_of_b() && !(step_.round_b.square > least));
  }
  // When the direction passes an axis, the support point of a rim jumps to its other side: the cap
  // may be closest. If it is not, the first step that passes the axis ends before it.
  [[nodiscard]] HWY_INLINE bool passes_axis() const {
    return (caps_of_a() && dot(step_.round_a.squared, step_.next) <= 0.0) ||
           (caps_of_b() && dot(step_.round_b.squared, step_.next) <= 0.0);
  }
  void stop_before_axis(Vec4 step) {
    double part = 1.0;
    const auto limit = [&](bool caps, const RoundSupport& round) HWY_ATTR {
      const double along = -dot(round.squared, step);
      if (caps && along > 0.0) part = std::min(part, 0.5 * round.square / along);
    };
    limit(caps_of_a(), step_.round_a);
    limit(caps_of_b(), step_.round_b);
    x_ = x_ + part * step;
  }
  // Tries a cap once per query: the cap of the cone whose axis is nearer to x.
  HWY_NOINLINE Next try_cap(Vec4 x) {
    if (cap_tried_) return Next::kGiveUp;
    cap_tried_ = true;
    const Vec4 m = -direction_to_b(a_from_b_, x);
    const auto across = [](Vec4 v)
                            HWY_ATTR { return lane(v, 0) * lane(v, 0) + lane(v, 1) * lane(v, 1); };
    const bool cap_is_of_a = caps_of_a() && (!caps_of_b() || across(x) <= across(m));
    const std::int32_t end_of_axis = lane(cap_is_of_a ? x : m, 2) > 0.0 ? 1 : 0;
    PartPair& pair = active_.pairs[0];
    active_.count = 1;
    (cap_is_of_a ? pair.a : pair.b) =
        first_planar_face(cap_is_of_a ? a_.body : b_.body) + end_of_axis;
    return try_face();
  }
  HWY_NOINLINE Next try_face() {
    Next next;
    do {
      ++end.supports;
      next = active_.pairs[0].a >= first_planar_face(a_.body) ? try_face_of<true>()
                                                              : try_face_of<false>();
    } while (HWY_UNLIKELY(next == Next::kOtherFace));
    return next;
  }
  template <bool kOfA>
  HWY_INLINE Next try_face_of() {
    const Side &side = kOfA ? a_ : b_, &other = kOfA ? b_ : a_;
    PartPair& pair = active_.pairs[0];
    std::int32_t &face = kOfA ? pair.a : pair.b, &part = kOfA ? pair.b : pair.a;
    active_.count = 1;
    const FaceProjection projection =
        project_on_face<kOfA>(side, other, a_from_b_, face, part, tolerance_);
    if (HWY_UNLIKELY(projection.end == FaceEnd::kUnknown)) {
      if (end.supports > 1) return Next::kGiveUp;
      forget_face<kOfA>();
      return Next::kIterate;
    }
    part = projection.part;
    const Vec4 normal = planar_face(side, face).normal;
    end.normal = kOfA ? normal : -direction_to_a(a_from_b_, normal);
    if (HWY_UNLIKELY(projection.end == FaceEnd::kBeside)) {
      const std::int32_t facing =
          facing_face(other, projection.part, normal_to_other<kOfA>(normal));
      if (facing != kNone && !facing_tried_) {
        facing_tried_ = true;
        face = part_of_face(side.body, face);
        part = facing;
        return Next::kOtherFace;
      }
      leave_face<kOfA>(projection);
      return Next::kIterate;
    }
    ended_on_face_ = true;
    end.lower = projection.lower;
    end.upper = projection.upper;
    end.on_a = kOfA ? projection.below : projection.on_other;
    end.on_b_B = kOfA ? projection.on_other : projection.below;
    end.on_b = point_to_a(a_from_b_, end.on_b_B);
    return end.upper - end.lower <= tolerance_ ? Next::kCertified : Next::kGiveUp;
  }
  // The other body's planar face at a part that is nearly parallel to a face. `down`: the opposite
  // of that face's normal, unit, in the other body's frame.
  [[nodiscard]] static HWY_NOINLINE std::int32_t facing_face(const Side& other, std::int32_t part,
                                                             Vec4 down) {
    const std::int32_t first = first_planar_face(other.body);
    if (other.is_round()) {
      const double z = lane(down, 2);
      const bool faces = other.round.has_caps && std::abs(z) > kFacing;
      return faces ? first + (z > 0.0 ? 1 : 0) : kNone;
    }
    const Vertex& vertex = other.body.vertices[static_cast<std::size_t>(part)];
    for (std::int32_t i = 0; i < vertex.edges; ++i) {
      const EdgeUse& use = other.body.vertex_edges[static_cast<std::size_t>(vertex.first_edge + i)];
      for (const std::int32_t facet : other.body.edges[static_cast<std::size_t>(use.edge)].facet) {
        if (facet == kNone) continue;
        const Facet& f = other.body.facets[static_cast<std::size_t>(facet)];
        if (dot(load3(f.normal), down) > kFacing) return first + facet;
      }
    }
    return kNone;
  }
  template <bool kOfA>
  [[nodiscard]] HWY_INLINE Vec4 normal_to_other(Vec4 normal) const {
    return -(kOfA ? direction_to_b(a_from_b_, normal) : direction_to_a(a_from_b_, normal));
  }
  // A disc, or a vertex, of a face.
  [[nodiscard]] static std::int32_t part_of_face(const ConvexBody& body, std::int32_t number) {
    const std::int32_t face = number - first_planar_face(body);
    if (body.is_curved()) return face;
    const Facet& facet = body.facets[static_cast<std::size_t>(face)];
    const EdgeUse& use = body.facet_edges[static_cast<std::size_t>(facet.first_side)];
    return body.edges[static_cast<std::size_t>(use.edge)].vertex[0];
  }
  // Continues from the last query's direction, where its face decides nothing any more.
  template <bool kOfA>
  HWY_NOINLINE void forget_face() {
    std::int32_t& face = kOfA ? active_.pairs[0].a : active_.pairs[0].b;
    face = part_of_face(kOfA ? a_.body : b_.body, face);
    parts_.place_all();
    grow();
  }
  // Continues from the edge or the rim past which the nearest point lies, or from the direction
  // before, if the bodies are farther apart along that one.
  template <bool kOfA>
  HWY_NOINLINE void leave_face(const FaceProjection& projection) {
    const Vec4 last = x_;
    const Side& side = kOfA ? a_ : b_;
    std::int32_t& face = kOfA ? active_.pairs[0].a : active_.pairs[0].b;
    if (side.is_round()) {
      face -= first_planar_face(side.body);
      const Disc& disc = side.round.parts[face];
      const double x = lane(projection.below, 0), y = lane(projection.below, 1);
      const double part = disc.radius / std::sqrt(x * x + y * y);
      const Vec4 out = projection.above - vec4(part * x, part * y, disc.height, 0.0);
      x_ = kOfA ? out : -direction_to_a(a_from_b_, out);
      cap_tried_ = true;
    } else {
      const Edge& edge = side.body.edges[static_cast<std::size_t>(projection.edge)];
      active_.count = 2;
      active_.pairs[1] = active_.pairs[0];
      face = edge.vertex[0];
      (kOfA ? active_.pairs[1].a : active_.pairs[1].b) = edge.vertex[1];
      x_ = end.normal;
    }
    parts_.place_all();
    const bool worse = grow() * std::sqrt(step_.square) < step_.least;
    if (worse && end.supports > 1) {
      x_ = last;
      grow();
    }
  }
  // Replaces three vertices of a facet by the facet.
  HWY_NOINLINE void to_facet() {
    const bool facet_is_of_a = !SquaresA::kRound;
    if (facet_is_of_a == !SquaresB::kRound) return;
    const SideParts other = parts_.side(!facet_is_of_a);
    if (other.number(0) != other.number(1) || other.number(0) != other.number(2)) return;
    const std::int32_t facet =
        facet_of(facet_is_of_a ? a_.body : b_.body, parts_.side(facet_is_of_a));
    if (facet == kNone) return;
    active_.count = 1;
    (facet_is_of_a ? active_.pairs[0].a : active_.pairs[0].b) = facet;
  }

  const Side &a_, &b_;
  const RelativePose4& a_from_b_;
  const double tolerance_;
  Vec4 x_;
  const bool ends_at_overlap_;
  ActiveParts& active_;
  PlacedParts parts_;
  NewtonStep<SquaresA, SquaresB> step_;
  bool cap_tried_ = false, facing_tried_ = false, stopped_ = false, ended_on_face_ = false;
};

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
