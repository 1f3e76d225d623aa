// transition() of core/feature_tracking/transitions-inl.hpp for as many pairs as a vector has
// lanes. Are the features still the closest ones, and where are the witness points? The geometry is
// the same code. The decisions are masks instead of branches: every lane makes all tests. Compiled
// once an instruction set.
#if defined(CLEARANCE_BATCH_FEATURES_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_BATCH_FEATURES_INL_HPP_
#undef CLEARANCE_BATCH_FEATURES_INL_HPP_
#else
#define CLEARANCE_BATCH_FEATURES_INL_HPP_
#endif

#include "core/batch/neighbours-inl.hpp"
#include "core/batch/pose-inl.hpp"
#include "core/feature_tracking/pair-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance {
namespace HWY_NAMESPACE {

// The findings of a transition that ends at kClosest, as in TrackedPair. They mean something only
// in lanes where `closest` is set.
struct Closest {
  HWY_INLINE Closest() {}  // as of Points

  LaneMask closest;  // the KKT conditions are satisfied by more than rounding
  Points point_a, point_b, local_b, normal;
  Lanes distance, certified;
  Lanes next, derivative;  // as of FailedLanes
};

// Are features at this distance (m) so far apart that they cannot touch? Else rounding decides on
// their direction.
HWY_INLINE LaneMask certainly_apart(const FeatureRows& at, const RelativePoses& pose,
                                    Lanes distance) {
  const Lanes size =
      (at.shared(kBoundingRadiusA) + at.shared(kBoundingRadiusB)) + norm(pose.translation);
  return hn::Gt(distance, all(kMayTouch) * size);
}

HWY_INLINE Closest vertex_vertex(const FeatureRows& at, const RelativePoses& pose) {
  Closest c;
  c.point_a = at.points(0);
  c.local_b = at.points(kVertexRows);
  c.point_b = point_to_a(pose, c.local_b);
  const Points g = c.point_b - c.point_a;
  c.distance = c.certified = norm(g);
  // g is as long as the distance of the vertices, and so are the errors of its products with unit
  // edges.
  const Lanes error = all(kDerivativeError) * c.distance;
  c.normal = over(g, c.distance);
  const Extreme on_a = Beside<false>{at, kDirectionsOfA}.greatest(g);
  const Extreme on_b = Beside<true>{at, kDirectionsOfB}.least(direction_to_b(pose, g));
  c.closest = hn::And(hn::Lt(on_a.derivative, hn::Neg(error)), hn::Gt(on_b.derivative, error));
  const Lanes of_b = hn::Neg(on_b.derivative);
  const LaneMask from_a = hn::And(hn::Gt(on_a.derivative, error), hn::Ge(on_a.derivative, of_b));
  c.derivative = hn::IfThenElse(from_a, on_a.derivative, of_b);
  c.next = hn::IfThenElse(from_a, on_a.which,
                          next_if(hn::Gt(of_b, error), named(on_b.which, kNextOfOther)));
  c.next = next_if(certainly_apart(at, pose, c.distance), c.next);
  return c;
}

// kIsB: the edge is B's.
template <bool kIsB>
HWY_INLINE Closest edge_vertex(const FeatureRows& at, const RelativePoses& pose) {
  Closest c;
  EdgeAndVertex<kIsB, RelativePoses, Points, Lanes> line(pose, at.points(0), at.points(3),
                                                         at.points(kEdgeRows));
  line.find_separation();
  const Lanes begin = at.lanes(6), end = at.lanes(7);
  const LaneMask within = hn::And(hn::Gt(line.s, begin), hn::Lt(line.s, end));
  // This is rare and takes a square root, so it is done only if a lane of the vector needs it
  // (kSlender).
  const LaneMask slender = hn::Lt(line.length, all(kSlender) * hn::Abs(line.s));
  Lanes of_separation = line.length;
  if (HWY_UNLIKELY(!hn::AllFalse(Tag(), slender))) {
    of_separation = hn::IfThenElse(slender, line.slender_length(), line.length);
  }
  const Lanes error = all(kDerivativeError) * line.length;
  const auto& owner = line.frame;
  const Extreme side =
      Beside<kIsB>{at, kInwardRow}.greatest_of_two(owner.direction_in_local(line.separation));
  const Extreme away = Beside<!kIsB>{at, kDirectionsAtEdge}.least(
      owner.opposite().direction_in_local(line.separation));
  const LaneMask recede = hn::Lt(side.derivative, hn::Neg(error));
  c.closest = hn::And(within, hn::And(recede, hn::Gt(away.derivative, error)));
  const LaneMask approaches =
      hn::And(hn::Gt(side.derivative, error), certainly_apart(at, pose, line.length));
  c.next = hn::IfThenElse(recede, next_if(hn::Gt(hn::Neg(away.derivative), error), away.which),
                          next_if(approaches, named(side.which, kNextBeside)));
  c.next = unless_past_end(begin, end, line.s, kNextEnd, c.next);
  line.place_witnesses(c, of_separation);
  return c;
}

// The least distance of a point from the sides of a facet, A's or B's, inward positive.
template <bool kOfB>
HWY_INLINE Extreme least_within(const FeatureRows& at, std::size_t row, const Points& p) {
  const std::size_t sides = kOfB ? at.block.most_b : at.block.most_a;
  Extreme least{all(0.0), all(0.0)};
  Lanes number = all(0.0);
  for (std::size_t i = 0; i < sides; ++i, row += kSideRows, number = after(number)) {
    least.lower(hn::Sub(dot(at.points(row), p), at.lanes(row + 3)), number);
  }
  return least;
}

template <bool kIsB>
using FacetPlanes = FacetPlane<kIsB, RelativePoses, Points, Lanes>;

// kIsB: the facet is B's.
template <bool kIsB>
HWY_INLINE Closest facet_vertex(const FeatureRows& at, const RelativePoses& pose) {
  Closest c;
  const FacetPlanes<kIsB> plane(pose, at.points(0), at.lanes(3));
  const Points tip = at.points(kFacetRows), local_tip = plane.frame.point_from_other(tip);
  c.distance = c.certified = plane.height(tip, local_tip);
  const Extreme within = least_within<kIsB>(at, kSides, local_tip);
  const Extreme away = Beside<!kIsB>{at, kDirectionsAtFacet}.least(
      plane.frame.opposite().direction_in_local(plane.n));
  const Lanes error = all(kDerivativeError);
  // The order is that of the scalar transition. Below the plane nothing is decided. Past a side of
  // the facet, that side takes over. Only above the facet, a descending edge takes over.
  const LaneMask above = hn::Gt(c.distance, all(0.0)), inside = hn::Ge(within.derivative, all(0.0));
  c.closest = hn::And(hn::And(above, inside), hn::Gt(away.derivative, error));
  const Lanes down =
      next_if(hn::Gt(hn::Neg(away.derivative), error), named(away.which, kNextOfOther));
  c.next = next_if(above, hn::IfThenElse(inside, down, within.which));
  c.derivative = c.distance / hn::Neg(away.derivative);  // m: along the edge down to the plane
  plane.place_witnesses(c, tip, local_tip);
  return c;
}

HWY_INLINE Closest edge_edge(const FeatureRows& at, const RelativePoses& pose) {
  Closest c;
  constexpr std::size_t kSecond = kEdgeRows;
  EdgeLines<RelativePoses, Points, Lanes> lines(pose, at.points(0), at.points(3),
                                                at.points(kSecond), at.points(kSecond + 3));
  lines.find_nearest();
  const Lanes begin_a = at.lanes(6), end_a = at.lanes(7);
  const Lanes begin_b = at.lanes(kSecond + 6), end_b = at.lanes(kSecond + 7);
  const LaneMask on_first = hn::And(hn::Gt(lines.s, begin_a), hn::Lt(lines.s, end_a));
  const LaneMask on_second = hn::And(hn::Gt(lines.t, begin_b), hn::Lt(lines.t, end_b));
  const Lanes sine = hn::Sqrt(lines.sine2), error = all(kDerivativeError) * sine;
  const Lanes along_n = dot(lines.between, lines.n);
  const Points g = hn::CopySign(all(1.0), along_n) * lines.n;
  const Extreme on_a = Beside<false>{at, kInwardRow}.greatest_of_two(g);
  const Extreme on_b = Beside<true>{at, kSecond + kInwardRow}.least_of_two(direction_to_b(pose, g));
  // If facets of both approach, the one that approaches faster takes over.
  const Lanes of_a = on_a.derivative, of_b = hn::Neg(on_b.derivative);
  const LaneMask stay_a = hn::And(hn::Gt(of_b, error), hn::Lt(of_a, of_b));
  const LaneMask stay_b = hn::And(hn::Gt(of_a, error), hn::Le(of_b, of_a));
  const LaneMask leave_a = hn::AndNot(stay_a, hn::Ge(of_a, hn::Neg(error)));
  const LaneMask leave_b = hn::AndNot(stay_b, hn::Le(on_b.derivative, error));
  const LaneMask recede =
      hn::And(hn::Lt(on_a.derivative, hn::Neg(error)), hn::Gt(on_b.derivative, error));
  const auto beside = [](LaneMask leave, const Extreme& side, double step) HWY_ATTR {
    return hn::IfThenElseZero(leave, hn::Mul(all(step), after(side.which)));
  };
  // Nearly parallel edges are left to distance(), which has parallel_edges() for them.
  const LaneMask crossing = hn::Gt(lines.sine2, all(kCrossingSine2));
  c.next = next_if(hn::And(hn::Or(leave_a, leave_b), certainly_apart(at, pose, hn::Abs(along_n))),
                   hn::Add(beside(leave_a, on_a, 1.0), beside(leave_b, on_b, kNextBesideB)));
  c.next = unless_past_end(begin_b, end_b, lines.t, kNextEndB, c.next);
  c.next = unless_past_end(begin_a, end_a, lines.s, kNextEnd, c.next);
  c.next = next_if(crossing, c.next);
  c.closest = hn::And(hn::And(crossing, recede), hn::And(on_first, on_second));
  c.normal = over(g, sine);
  lines.place_witnesses(c);
  c.distance = norm(c.point_b - c.point_a);
  c.certified =
      hn::Abs(along_n) / sine -
      lines.tilt_error_of_edges(c.normal, at.shared(kBoundingRadiusA), at.shared(kBoundingRadiusB));
  return c;
}

}  // namespace HWY_NAMESPACE
}  // namespace clearance
HWY_AFTER_NAMESPACE();

#endif
