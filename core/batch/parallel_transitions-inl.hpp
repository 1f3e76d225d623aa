// The straight-line part of core/feature_tracking/parallel_transitions-inl.hpp, for one pair in
// each lane of a vector. It treats parallel features, where more than one point is closest within
// tolerance. Compiled once an instruction set.
#if defined(CLEARANCE_BATCH_LEVEL_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_BATCH_LEVEL_INL_HPP_
#undef CLEARANCE_BATCH_LEVEL_INL_HPP_
#else
#define CLEARANCE_BATCH_LEVEL_INL_HPP_
#endif

#include "core/batch/transitions-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance {
namespace HWY_NAMESPACE {

// The smaller bounding radius; that of an unbounded body is infinite.
HWY_INLINE Lanes least_bounding_radius(const FeatureRows& at) {
  if (HWY_LIKELY(at.block.plain))
    return hn::Min(at.shared(kBoundingRadiusA), at.shared(kBoundingRadiusB));
  const auto radius = [&](SharedRow unbounded, SharedRow row) HWY_ATTR {
    return hn::IfThenElse(hn::Eq(at.shared(unbounded), all(0.0)), at.shared(row), all(kInfinity));
  };
  return hn::Min(radius(kUnboundedA, kBoundingRadiusA), radius(kUnboundedB, kBoundingRadiusB));
}

// m: features that are parallel only within rounding may be nearer to each other by this than at
// the witness points. It is the tilt over the length of the smaller body.
HWY_INLINE Lanes tilt_error(const FeatureRows& at, Lanes tilt) {
  return hn::Mul(hn::Mul(all(2.0), least_bounding_radius(at)), hn::Add(tilt, all(kTiltError)));
}

// The part of a line that lies within the sides of a facet.
struct Spans {
  Lanes from, to;
};

// The part of a line between `from` and `to` that lies within the sides, in the frame of the facet,
// A's or B's. Line clipping against a convex polygon (Cyrus and Beck 1978): every side cuts off
// what lies on its outer half-plane.
template <bool kOfB>
HWY_INLINE Spans within_sides(const FeatureRows& at, std::size_t row, const Points& start,
                              const Points& direction, Lanes from, Lanes to) {
  const Lanes zero = all(0.0);
  Spans span{from, to};
  const std::size_t sides = kOfB ? at.block.most_b : at.block.most_a;
  for (std::size_t i = 0; i < sides; ++i, row += kSideRows) {
    const Points inward = at.points(row);
    const Lanes speed = dot(inward, direction);
    const Lanes gap = hn::Sub(dot(inward, start), at.lanes(row + 3));
    const Lanes meets = hn::Div(hn::Neg(gap), speed);
    const LaneMask enters = hn::And(hn::Gt(speed, zero), hn::Gt(meets, span.from));
    const LaneMask leaves = hn::And(hn::Lt(speed, zero), hn::Lt(meets, span.to));
    span.from = hn::IfThenElse(enters, meets, span.from);
    span.to = hn::IfThenElse(leaves, meets, span.to);
    // Parallel to the side and outside: nothing is left.
    const LaneMask beside = hn::And(hn::Eq(speed, zero), hn::Lt(gap, zero));
    span.to = hn::IfThenElse(beside, span.from, span.to);
  }
  return span;
}

// The same as std::clamp.
HWY_INLINE Lanes clamp(Lanes value, Lanes low, Lanes high) {
  return hn::IfThenElse(hn::Lt(value, low), low, hn::IfThenElse(hn::Lt(high, value), high, value));
}

// kOfB: the facet is B's, the edge A's, no side of which approaches or recedes.
template <bool kOfB>
HWY_INLINE Closest edge_facet(const FeatureRows& at, const RelativePoses& pose) {
  Closest c;
  const FacetPlanes<kOfB> plane(pose, at.points(0), at.lanes(3));
  const auto& frame = plane.frame;
  constexpr std::size_t kEdge = kFacetRows;
  const Points start = at.points(kEdge), e = at.points(kEdge + 3);
  const Spans span =
      within_sides<kOfB>(at, kSidesAtEdge, frame.point_from_other(start),
                         frame.direction_from_other(e), at.lanes(kEdge + 6), at.lanes(kEdge + 7));
  const Points up = frame.opposite().direction_in_local(plane.n);
  const Lanes tilt = hn::Abs(dot(e, up));
  const Lanes away = Beside<!kOfB>{at, kEdge + kInwardRow}.least_of_two(up).derivative;
  const Points mine = at.shared_points(kOfB ? kPointA : kPointB);
  const Points theirs = frame.point_to_other(at.shared_points(kOfB ? kPointB : kPointA));
  const Lanes halfway = dot(mine + all(0.5) * (theirs - mine) - start, e);
  const Points local = start + clamp(halfway, span.from, span.to) * e;
  const Points above = frame.point_from_other(local);
  c.distance = plane.height(local, above);
  c.certified = hn::Sub(c.distance, tilt_error(at, tilt));
  c.closest = hn::And(hn::And(hn::Gt(c.distance, all(0.0)), hn::Gt(away, all(kDerivativeError))),
                      hn::And(hn::Le(tilt, all(kDerivativeError)), hn::Lt(span.from, span.to)));
  c.next = all(kNextUnknown);
  plane.place_witnesses(c, local, above);
  return c;
}

HWY_INLINE Closest facet_facet(const FeatureRows& at, const RelativePoses& pose) {
  Closest c;
  const Points n = at.points(0), m = at.points(kFacetRows);
  const Lanes offset_a = at.lanes(3), offset_b = at.lanes(kFacetRows + 3);
  const Points tilt = direction_to_b(pose, n) + m;
  const Lanes tilt2 = dot(tilt, tilt);
  const Points mine = at.shared_points(kPointB);
  const Points theirs = point_to_b(pose, at.shared_points(kPointA));
  // Halfway between the last witness points: they move no faster than the bodies do.
  const Points middle = mine + all(0.5) * (theirs - mine);
  const Lanes height = hn::Sub(dot(m, middle), offset_b);
  c.local_b = middle - height * m;
  c.point_b = point_to_a(pose, c.local_b);
  c.distance = hn::Sub(dot(n, c.point_b), offset_a);
  c.point_a = c.point_b - c.distance * n;
  c.normal = n;
  c.certified = hn::Sub(c.distance, tilt_error(at, hn::Sqrt(tilt2)));
  const Lanes within = hn::Min(least_within<false>(at, kSidesOfA, c.point_b).derivative,
                               least_within<true>(at, kSidesOfB, c.local_b).derivative);
  c.next = all(kNextUnknown);
  const Lanes size = hn::Add(hn::Add(at.shared(kBoundingRadiusA), at.shared(kBoundingRadiusB)),
                             norm(pose.translation));
  // The same test as in halfway_on_facet(): the last witness points may be far off the plane.
  const LaneMask on_facet = hn::Le(hn::Abs(height), hn::Mul(all(2.0), size));
  c.closest = hn::And(hn::And(hn::Gt(c.distance, all(0.0)), hn::Ge(within, all(0.0))),
                      hn::And(hn::Le(tilt2, all(kParallelTilt * kParallelTilt)), on_facet));
  return c;
}

}  // namespace HWY_NAMESPACE
}  // namespace clearance
HWY_AFTER_NAMESPACE();

#endif
