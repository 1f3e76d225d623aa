// The straight-line part of core/feature_walk/steps-inl.hpp, operation for operation, for as many
// pairs as a vector has lanes: are these features the closest ones still, and where do they put the
// witness points? Compiled once an instruction set.
#if defined(CLEARANCE_BATCH_FEATURES_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_BATCH_FEATURES_INL_HPP_
#undef CLEARANCE_BATCH_FEATURES_INL_HPP_
#else
#define CLEARANCE_BATCH_FEATURES_INL_HPP_
#endif

#include "core/batch/neighbours-inl.hpp"
#include "core/batch/pose-inl.hpp"
#include "core/feature_walk/feature_walk.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance {
namespace HWY_NAMESPACE {

// What a step of core/feature_walk/steps-inl.hpp finds, where `holds`; elsewhere anything.
struct Closest {
  HWY_INLINE Closest() {}  // as of Points

  LaneMask holds;
  Points point_a, point_b, own_b, normal;
  Lanes apart, proved;
  Lanes next, rate;  // as of FailedLanes
};

HWY_INLINE Closest vertex_vertex(const FeatureRows& at, const RelativePoses& pose) {
  Closest c;
  c.point_a = at.points(0);
  c.own_b = at.points(kVertexRows);
  c.point_b = rotate(pose.rotation, c.own_b) + pose.translation;
  const Points g = c.point_b - c.point_a;
  c.apart = c.proved = norm(g);
  const Lanes certain = hn::Mul(all(kCertainRate), c.apart);
  c.normal = over(g, c.apart);
  const Extreme on_a = Beside<false>{at, kDirectionsOfA}.greatest_rate(g);
  const Extreme on_b = Beside<true>{at, kDirectionsOfB}.least_rate(rotate_back(pose.rotation, g));
  c.holds = hn::And(hn::Lt(on_a.rate, hn::Neg(certain)), hn::Gt(on_b.rate, certain));
  const Lanes rate_b = hn::Neg(on_b.rate);
  const LaneMask of_a = hn::And(hn::Gt(on_a.rate, certain), hn::Ge(on_a.rate, rate_b));
  c.rate = hn::IfThenElse(of_a, on_a.rate, rate_b);
  c.next = hn::IfThenElse(of_a, on_a.which,
                          if_certain(hn::Gt(rate_b, certain), named(on_b.which, kNextOfOther)));
  return c;
}

// As over_norm() and over_square() of core/feature_walk/pair-inl.hpp.
HWY_INLINE Lanes over_norm(const Points& v) {
  return hn::Sub(all(1.5), hn::Mul(all(0.5), dot(v, v)));
}
HWY_INLINE Lanes over_square(const Points& v) { return hn::Sub(all(2.0), dot(v, v)); }

// A body in frame A, and what is in frame A in its own. kIsB: it is B.
template <bool kIsB>
struct CommonFrame {
  const RelativePoses& pose;

  [[nodiscard]] HWY_INLINE Points point_to_common(const Points& p) const {
    if constexpr (kIsB) return rotate(pose.rotation, p) + pose.translation;
    return p;
  }
  [[nodiscard]] HWY_INLINE Points direction_to_common(const Points& v) const {
    if constexpr (kIsB) return rotate(pose.rotation, v);
    return v;
  }
  [[nodiscard]] HWY_INLINE Points direction_to_own(const Points& v) const {
    if constexpr (kIsB) return rotate_back(pose.rotation, v);
    return v;
  }
};

// kMoved: the edge is B's.
template <bool kMoved>
HWY_INLINE Closest edge_vertex(const FeatureRows& at, const RelativePoses& pose) {
  Closest c;
  const CommonFrame<kMoved> owner{pose};
  const CommonFrame<!kMoved> other{pose};
  const Points own_start = at.points(0), own_e = at.points(3), own_tip = at.points(kEdgeRows);
  const Points tip = other.point_to_common(own_tip), start = owner.point_to_common(own_start);
  const Points e = owner.direction_to_common(own_e), from_start = tip - start;
  Lanes s = dot(from_start, e);
  if constexpr (kMoved) s = hn::Mul(s, over_square(e));
  const Lanes begin = at.lanes(6), end = at.lanes(7);
  const LaneMask within = hn::And(hn::Gt(s, begin), hn::Lt(s, end));
  const Points across = cross(from_start, e), way = cross(e, across);
  const Lanes length = norm(across);
  const LaneMask slender = hn::Lt(length, hn::Mul(all(kSlender), hn::Abs(s)));
  Lanes of_way = length;
  if (HWY_UNLIKELY(!hn::AllFalse(Tag(), slender))) {
    Lanes of_slender = norm(way);
    if constexpr (kMoved) of_slender = hn::Div(of_slender, over_norm(e));
    of_way = hn::IfThenElse(slender, of_slender, length);
  }
  const Lanes certain = hn::Mul(all(kCertainRate), length);
  const Extreme side = Beside<kMoved>{at, kInwardRow}.greatest_of_two(owner.direction_to_own(way));
  const Extreme away =
      Beside<!kMoved>{at, kDirectionsAtEdge}.least_rate(other.direction_to_own(way));
  const LaneMask falls = hn::Lt(side.rate, hn::Neg(certain));
  c.holds = hn::And(within, hn::And(falls, hn::Gt(away.rate, certain)));
  c.next = hn::IfThenElse(falls, if_certain(hn::Gt(hn::Neg(away.rate), certain), away.which),
                          if_certain(hn::Gt(side.rate, certain), named(side.which, kNextBeside)));
  c.next = unless_beyond(begin, end, s, kNextEnd, c.next);
  const Points own = own_start + times(s, own_e), common = start + times(s, e);
  if constexpr (kMoved) {
    const Lanes unit = over_norm(e);
    c.apart = c.proved = hn::Mul(unit, length);
    c.normal = over(times(hn::Neg(unit), way), of_way);
    c.point_a = tip;
    c.own_b = own;
    c.point_b = common;
  } else {
    c.apart = c.proved = length;
    c.normal = over(way, of_way);
    c.point_a = common;
    c.own_b = own_tip;
    c.point_b = tip;
  }
  return c;
}

// How far within the sides of a facet, A's or B's, a point lies at least; zero: at most on one.
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

// A facet, A's or B's, and what is above it: as Owned of core/feature_walk/pair-inl.hpp.
template <bool kOfB>
struct Ground {
  const RelativePoses& pose;
  Points own_n, n;  // the normal in its body's frame, and in A's
  Lanes offset;

  HWY_INLINE Ground(const FeatureRows& at, const RelativePoses& relative)
      : pose(relative),
        own_n(at.points(0)),
        n(CommonFrame<kOfB>{relative}.direction_to_common(own_n)),
        offset(at.lanes(3)) {}

  // From the other body's frame to the facet's.
  [[nodiscard]] HWY_INLINE Points point_in(const Points& p) const {
    if constexpr (kOfB) return rotate_back(pose.rotation, p - pose.translation);
    return rotate(pose.rotation, p) + pose.translation;
  }
  [[nodiscard]] HWY_INLINE Points direction_in(const Points& v) const {
    if constexpr (kOfB) return rotate_back(pose.rotation, v);
    return rotate(pose.rotation, v);
  }
  // And back.
  [[nodiscard]] HWY_INLINE Points point_out(const Points& p) const {
    if constexpr (kOfB) return rotate(pose.rotation, p) + pose.translation;
    return rotate_back(pose.rotation, p - pose.translation);
  }
  // `others`: in the other body's frame, `own`: in the facet's.
  [[nodiscard]] HWY_INLINE Lanes height(const Points& others, const Points& own) const {
    if constexpr (kOfB) {
      return hn::Sub(hn::Mul(over_norm(n), dot(n, others - pose.translation)), offset);
    }
    return hn::Sub(dot(n, own), offset);
  }
  // The witness points, c.apart from each other, and the normal.
  HWY_INLINE void place_above(const Points& others, const Points& own, Closest& c) const {
    if constexpr (kOfB) {
      c.own_b = own - times(hn::Sub(dot(own_n, own), offset), own_n);
      c.point_a = others;
      c.point_b = point_out(c.own_b);
      c.normal = times(hn::Neg(over_norm(n)), n);
    } else {
      c.point_a = own - times(c.apart, n);
      c.own_b = others;
      c.point_b = own;
      c.normal = n;
    }
  }
};

// kOfB: the facet is B's.
template <bool kOfB>
HWY_INLINE Closest facet_vertex(const FeatureRows& at, const RelativePoses& pose) {
  Closest c;
  const Ground<kOfB> facet(at, pose);
  const Points tip = at.points(kFacetRows), own_tip = facet.point_in(tip);
  c.apart = c.proved = facet.height(tip, own_tip);
  const Extreme within = least_within<kOfB>(at, kSides, own_tip);
  const Extreme away = Beside<!kOfB>{at, kDirectionsAtFacet}.least_rate(
      CommonFrame<!kOfB>{pose}.direction_to_own(facet.n));
  const LaneMask above = hn::Gt(c.apart, all(0.0)), inside = hn::Ge(within.rate, all(0.0));
  c.holds = hn::And(hn::And(above, inside), hn::Gt(away.rate, all(kCertainRate)));
  const Lanes down =
      if_certain(hn::Gt(hn::Neg(away.rate), all(kCertainRate)), named(away.which, kNextOfOther));
  c.next = if_certain(above, hn::IfThenElse(inside, down, within.which));
  facet.place_above(tip, own_tip, c);
  return c;
}

HWY_INLINE Closest edge_edge(const FeatureRows& at, const RelativePoses& pose) {
  Closest c;
  constexpr std::size_t kSecond = kEdgeRows;
  const Points first = at.points(0), e = at.points(3);
  const Points second = at.points(kSecond), direction = at.points(kSecond + 3);
  const Points f = rotate(pose.rotation, direction);
  const Points start_b = rotate(pose.rotation, second) + pose.translation;
  const Points between = start_b - first;
  const Points n = cross(e, f);
  const Lanes sine2 = dot(n, n), cosine = dot(e, f), along_e = dot(between, e);
  const Lanes t = hn::Div(dot(cross(between, e), n), sine2);
  const Lanes s = hn::Add(along_e, hn::Mul(cosine, t));
  const Lanes begin_a = at.lanes(6), end_a = at.lanes(7);
  const Lanes begin_b = at.lanes(kSecond + 6), end_b = at.lanes(kSecond + 7);
  const LaneMask on_first = hn::And(hn::Gt(s, begin_a), hn::Lt(s, end_a));
  const LaneMask on_second = hn::And(hn::Gt(t, begin_b), hn::Lt(t, end_b));
  const Lanes sine = hn::Sqrt(sine2), certain = hn::Mul(all(kCertainRate), sine);
  const Lanes apart = dot(between, n);
  const Points g = times(hn::CopySign(all(1.0), apart), n);
  const Extreme on_a = Beside<false>{at, kInwardRow}.greatest_of_two(g);
  const Extreme on_b =
      Beside<true>{at, kSecond + kInwardRow}.least_of_two(rotate_back(pose.rotation, g));
  const LaneMask rises_a = hn::Ge(on_a.rate, hn::Neg(certain));
  const LaneMask rises_b = hn::Le(on_b.rate, certain);
  const LaneMask falls = hn::And(hn::Lt(on_a.rate, hn::Neg(certain)), hn::Gt(on_b.rate, certain));
  const auto beside = [](LaneMask rises, const Extreme& side, double step) HWY_ATTR {
    return hn::IfThenElseZero(rises, hn::Mul(all(step), after(side.which)));
  };
  c.next = if_certain(hn::Or(rises_a, rises_b),
                      hn::Add(beside(rises_a, on_a, 1.0), beside(rises_b, on_b, kNextBesideB)));
  c.next = unless_beyond(begin_b, end_b, t, kNextEndB, c.next);
  c.next = unless_beyond(begin_a, end_a, s, kNextEnd, c.next);
  c.next = if_certain(hn::Gt(sine2, all(kCrossingSine2)), c.next);
  c.normal = over(g, sine);
  c.holds =
      hn::And(hn::And(hn::Gt(sine2, all(kCrossingSine2)), falls), hn::And(on_first, on_second));
  c.point_a = first + times(s, e);
  c.own_b = second + times(t, direction);
  c.point_b = start_b + times(t, f);
  c.apart = norm(c.point_b - c.point_a);
  const Lanes tilt = hn::Add(hn::Mul(at.common(kReachA), hn::Abs(dot(c.normal, e))),
                             hn::Mul(at.common(kReachB), hn::Abs(dot(c.normal, f))));
  c.proved = hn::Sub(hn::Div(hn::Abs(apart), sine), hn::Mul(all(2.0), tilt));
  return c;
}

}  // namespace HWY_NAMESPACE
}  // namespace clearance
HWY_AFTER_NAMESPACE();

#endif
