// A pair of bodies and the features that may be closest: their geometry in straight-line
// arithmetic, and what a walk keeps of them. What a transition decides from it is in
// core/feature_walk/steps-inl.hpp. Compiled once a vector width: see core/numerics/vec4-inl.hpp.
//
// The geometry is written once over the type of vectors: for one pair (Vec4, RelativePose4; a
// Number is a double) and for as many pairs as a batch's vectors have lanes (Points, RelativePoses;
// Lanes). Both round in the same order, so that a batch gives the bits of single queries.
#if defined(CLEARANCE_CORE_TRACKED_PAIR) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_TRACKED_PAIR
#undef CLEARANCE_CORE_TRACKED_PAIR
#else
#define CLEARANCE_CORE_TRACKED_PAIR
#endif

#include <cmath>
#include <type_traits>

#include "core/feature_walk/feature_pair.hpp"
#include "core/feature_walk/feature_walk.hpp"
#include "core/model/relative_pose-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

template <class Number>
HWY_INLINE Number number(double value) {
  if constexpr (std::is_same_v<Number, double>) {
    return value;
  } else {
    return hwy::HWY_NAMESPACE::Set(hwy::HWY_NAMESPACE::DFromV<Number>(), value);
  }
}
template <class Number>
HWY_INLINE Number magnitude(Number value) {
  if constexpr (std::is_same_v<Number, double>) {
    return std::abs(value);
  } else {
    return hwy::HWY_NAMESPACE::Abs(value);
  }
}

// 1/|v| and 1/|v|^2 of what is a unit vector up to some roundings.
template <class Vector>
HWY_INLINE auto over_norm(const Vector& v) {
  const auto square = dot(v, v);
  using Number = std::remove_cv_t<decltype(square)>;
  return number<Number>(1.5) - number<Number>(0.5) * square;
}
template <class Vector>
HWY_INLINE auto over_square(const Vector& v) {
  const auto square = dot(v, v);
  return number<std::remove_cv_t<decltype(square)>>(2.0) - square;
}

// One of the bodies, A or B, with the other. The common frame is A's.
template <bool kIsB, class Relative>
struct BodyFrame {
  const Relative& a_from_b;

  [[nodiscard]] HWY_INLINE BodyFrame<!kIsB, Relative> opposite() const { return {a_from_b}; }
  // From the other body's frame to this one's, and back.
  template <class Vector>
  [[nodiscard]] HWY_INLINE Vector point_in(const Vector& p) const {
    if constexpr (kIsB) return point_to_b(a_from_b, p);
    return point_to_a(a_from_b, p);
  }
  template <class Vector>
  [[nodiscard]] HWY_INLINE Vector direction_in(const Vector& v) const {
    if constexpr (kIsB) return direction_to_b(a_from_b, v);
    return direction_to_a(a_from_b, v);
  }
  template <class Vector>
  [[nodiscard]] HWY_INLINE Vector point_out(const Vector& p) const {
    return opposite().point_in(p);
  }
  template <class Vector>
  [[nodiscard]] HWY_INLINE Vector direction_out(const Vector& v) const {
    return opposite().direction_in(v);
  }
  // From this body's frame to the common one, and back.
  template <class Vector>
  [[nodiscard]] HWY_INLINE Vector point_to_common(const Vector& p) const {
    if constexpr (kIsB) return point_to_a(a_from_b, p);
    return p;
  }
  template <class Vector>
  [[nodiscard]] HWY_INLINE Vector direction_to_common(const Vector& v) const {
    if constexpr (kIsB) return direction_to_a(a_from_b, v);
    return v;
  }
  template <class Vector>
  [[nodiscard]] HWY_INLINE Vector direction_to_own(const Vector& v) const {
    if constexpr (kIsB) return direction_to_b(a_from_b, v);
    return v;
  }

  // Witness points: on this body in its own frame and in the common one, and so of the other.
  template <class Found, class Vector>
  HWY_INLINE void place(Found& found, const Vector& own, const Vector& common,
                        const Vector& others_own, const Vector& others_common) const {
    if constexpr (kIsB) {
      found.point_a = others_common;
      found.own_b = own;
      found.point_b = common;
    } else {
      found.point_a = common;
      found.own_b = others_own;
      found.point_b = others_common;
    }
  }
};

// The plane of a facet of this body, and what is above it. `others` is a point of the other body by
// itself, `own` the same in this body's frame.
template <bool kIsB, class Relative, class Vector, class Number>
struct FacetPlane {
  HWY_INLINE FacetPlane(const Relative& pose, const Vector& normal, Number plane_offset)
      : frame{pose}, own_n(normal), n(frame.direction_to_common(normal)), offset(plane_offset) {}

  // m: how far outside.
  [[nodiscard]] HWY_INLINE Number height(const Vector& others, const Vector& own) const {
    if constexpr (kIsB) {
      return over_norm(n) * dot(n, others - frame.a_from_b.translation) - offset;
    } else {
      return dot(n, own) - offset;
    }
  }
  // The witness points, found.apart from each other, and the normal.
  template <class Found>
  HWY_INLINE void place_witnesses(Found& found, const Vector& others, const Vector& own) const {
    if constexpr (kIsB) {
      const Vector below = own - (dot(own_n, own) - offset) * own_n;
      frame.place(found, below, point_to_a(frame.a_from_b, below), others, others);
      found.normal = -(over_norm(n) * n);
    } else {
      const Vector below = own - found.apart * n;
      frame.place(found, below, below, others, own);
      found.normal = n;
    }
  }

  BodyFrame<kIsB, Relative> frame;
  Vector own_n, n;  // outward, in this body's frame and in the common one
  Number offset;    // m
};

// An edge of this body and a vertex of the other, in frame A, where B is what the rotation's
// doubles make of it: not quite rigid, and so neither are its unit vectors of unit length. Seen
// from B it would be A that is stretched, however far away.
template <bool kIsB, class Relative, class Vector, class Number>
struct EdgeAndVertex {
  HWY_INLINE EdgeAndVertex(const Relative& pose, const Vector& edge_start, const Vector& direction,
                           const Vector& vertex)
      : frame{pose},
        own_start(edge_start),
        own_e(direction),
        own_tip(vertex),
        tip(frame.opposite().point_to_common(vertex)),
        start(frame.point_to_common(edge_start)),
        e(frame.direction_to_common(direction)),
        from_start(tip - start),
        s(along_edge()) {}

  // From the edge to the vertex: `separation`, as long as `across` and at right angles to it. No
  // difference of long vectors, whose cancellation would leave something along the edge.
  HWY_INLINE void find_separation() {
    across = cross(from_start, e);
    separation = cross(e, across);
    length = norm(across);
  }
  // |separation|, computed anew where cross products are too coarse: kSlender.
  [[nodiscard]] HWY_INLINE Number slender_length() const {
    if constexpr (kIsB) return norm(separation) / over_norm(e);
    return norm(separation);
  }
  // `of_separation`: what `separation` is divided by.
  template <class Found>
  HWY_INLINE void place_witnesses(Found& found, Number of_separation) const {
    if constexpr (kIsB) {
      const Number unit = over_norm(e);
      found.apart = found.certified = unit * length;
      found.normal = over(-(unit * separation), of_separation);
    } else {
      found.apart = found.certified = length;
      found.normal = over(separation, of_separation);
    }
    frame.place(found, own_start + s * own_e, start + s * e, own_tip, tip);
  }

  BodyFrame<kIsB, Relative> frame;
  Vector own_start, own_e, own_tip, tip, start, e, from_start;
  Number s;  // m: where along the edge the vertex is
  Vector across, separation;
  Number length;  // m

 private:
  [[nodiscard]] HWY_INLINE Number along_edge() const {
    if constexpr (kIsB) return dot(from_start, e) * over_square(e);
    return dot(from_start, e);
  }
};

// The lines of an edge of A and one of B, in frame A but for own_..., and where they are nearest.
template <class Relative, class Vector, class Number>
struct EdgeLines {
  HWY_INLINE EdgeLines(const Relative& pose, const Vector& start_of_a, const Vector& direction_of_a,
                       const Vector& start_of_b, const Vector& direction_of_b)
      : e(direction_of_a),
        own_f(direction_of_b),
        start_a(start_of_a),
        own_start_b(start_of_b),
        f(direction_to_a(pose, direction_of_b)),
        start_b(point_to_a(pose, start_of_b)),
        between(start_b - start_a),
        n(cross(e, f)),
        sine2(dot(n, n)) {}

  // s along the first and t along the second: of lines that cross. What lies between them along e
  // is taken off first, so that its rounding is over the sine, and not over the sine's square.
  HWY_INLINE void find_nearest() {
    const Number cosine = dot(e, f), along_e = dot(between, e);
    t = dot(cross(between, e), n) / sine2;
    s = along_e + cosine * t;
  }
  template <class Found>
  HWY_INLINE void place_witnesses(Found& found) const {
    found.point_a = start_a + s * e;
    found.own_b = own_start_b + t * own_f;
    found.point_b = start_b + t * f;
  }

  // m: how much farther along an edge a body may reach, by what rounding tilts the normal. The
  // radii are those of spheres around the frames' origins.
  [[nodiscard]] HWY_INLINE Number reach_of_tilt(const Vector& normal, Number radius_a,
                                                Number radius_b) const {
    return number<Number>(2.0) *
           (radius_a * magnitude(dot(normal, e)) + radius_b * magnitude(dot(normal, f)));
  }

  Vector e, own_f, start_a, own_start_b, f, start_b, between, n;
  Number sine2;
  Number s, t;  // m
};

// Transitions from two vertices to two facets are four at most; more of them go round in circles.
inline constexpr int kMostParallel = 6;

// What a pair of features comes to.
enum class Transition {
  kClosest,    // the KKT conditions are satisfied beyond rounding: these are the closest features
  kMoved,      // a neighbouring feature takes over
  kDeferred,   // of a first transition: the features are parallel, which is not decided there
  kUndecided,  // rounding cannot tell, or this pair is none for straight-line code
};

using Side = TrackingState::Side;

// The pair, and what the transition that ends at kClosest finds.
struct TrackedPair {
  HWY_INLINE TrackedPair(const ConvexBody& body_a, const ConvexBody& body_b,
                         const RelativePose4& pose, TrackingState& state, WalkStart at = {})
      : a(body_a),
        b(body_b),
        a_from_b(pose),
        on_a(state.a),
        on_b(state.b),
        transitions(at.transitions),
        parallel_transitions(at.parallel_transitions) {}

  const ConvexBody& a;
  const ConvexBody& b;
  const RelativePose4& a_from_b;
  Side& on_a;
  Side& on_b;
  Vec4 point_a, point_b;  // witness points, frame A
  Vec4 own_b;             // point_b in frame B
  Vec4 normal;            // unit, from A to B, frame A
  double apart;           // m: |point_b - point_a|; of penetrating bodies minus the depth
  double certified;    // m: how far apart the normal certifies the polyhedra, but for error_bound
  double error_bound;  // m: Precision::error_bound
  int transitions;
  int parallel_transitions;  // of these, to features that are parallel within tolerance

  // Of penetrating bodies (core/feature_walk/penetrating_steps-inl.hpp).
  bool penetrating = false;
  double room;    // m: of the edges' crossing, to their ends
  double beyond;  // m: the bodies may penetrate by this less

  [[nodiscard]] HWY_INLINE FeaturePair features() const {
    return feature_pair(on_a.kind, on_b.kind);
  }

  // After a transition to features that are parallel. Rounding may have them go round in circles.
  [[nodiscard]] HWY_INLINE Transition parallel() {
    return ++parallel_transitions > kMostParallel ? Transition::kUndecided : Transition::kMoved;
  }
};

// The features that take over. Poses that are no poses lead beyond the ends of edges that have
// none: to no feature.
HWY_INLINE Transition to_vertex(Side& side, std::int32_t vertex) {
  side.kind = vertex == kNone ? FeatureKind::kUnknown : FeatureKind::kVertex;
  side.feature = vertex;
  return Transition::kMoved;
}
HWY_INLINE Transition to_edge(Side& side, std::int32_t edge) {
  side.kind = FeatureKind::kEdge;
  side.feature = edge;
  return Transition::kMoved;
}
HWY_INLINE Transition to_facet(Side& side, std::int32_t facet) {
  side.kind = FeatureKind::kFacet;
  side.feature = facet;
  return Transition::kMoved;
}

// One of the bodies, the owner of an edge or facet, with its frame, and the other with its vertex.
template <bool kIsB>
struct Owner : BodyFrame<kIsB, RelativePose4> {
  HWY_INLINE explicit Owner(TrackedPair& of)
      : BodyFrame<kIsB, RelativePose4>{of.a_from_b}, pair(of) {}

  [[nodiscard]] HWY_INLINE const ConvexBody& body() const { return kIsB ? pair.b : pair.a; }
  [[nodiscard]] HWY_INLINE const ConvexBody& other_body() const { return kIsB ? pair.a : pair.b; }
  [[nodiscard]] HWY_INLINE Side& side() const { return kIsB ? pair.on_b : pair.on_a; }
  [[nodiscard]] HWY_INLINE Side& other_side() const { return kIsB ? pair.on_a : pair.on_b; }

  TrackedPair& pair;
};

template <bool kIsB>
HWY_INLINE FacetPlane<kIsB, RelativePose4, Vec4, double> plane_of(
    const BodyFrame<kIsB, RelativePose4>& frame, const Facet& facet) {
  return {frame.a_from_b, load3_of_4(facet.normal), facet.offset};
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
