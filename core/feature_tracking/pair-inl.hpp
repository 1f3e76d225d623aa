// A pair of bodies and the features that may be closest: their geometry in straight-line
// arithmetic, and TrackedPair, which keeps the results. The decisions of a transition are in
// core/feature_tracking/transitions-inl.hpp. Compiled once a vector width: see
// core/numerics/vec4-inl.hpp.
//
// The geometry is written once over the type of vectors. A single query uses Vec4, RelativePose4
// and double for Vector, Relative and Number; a batch uses Points, RelativePoses and Lanes, with
// one pair per lane. Both round in the same order, so that a batch gives the bits of single
// queries.
#if defined(CLEARANCE_CORE_TRACKED_PAIR) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_TRACKED_PAIR
#undef CLEARANCE_CORE_TRACKED_PAIR
#else
#define CLEARANCE_CORE_TRACKED_PAIR
#endif

#include <cmath>
#include <type_traits>

#include "core/feature_tracking/feature_pair.hpp"
#include "core/feature_tracking/feature_tracking.hpp"
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

// 1/|v| and 1/|v|^2 of a vector whose length is 1 up to some roundings: one Newton step for
// x^(-1/2), and for 1/x, from 1. The error is of second order.
template <class Vector>
HWY_INLINE auto inverse_norm_near_1(const Vector& v) {
  const auto square = dot(v, v);
  using Number = std::remove_cv_t<decltype(square)>;
  return number<Number>(1.5) - number<Number>(0.5) * square;
}
template <class Vector>
HWY_INLINE auto inverse_square_near_1(const Vector& v) {
  const auto square = dot(v, v);
  return number<std::remove_cv_t<decltype(square)>>(2.0) - square;
}

// One of the bodies, A or B, and its pose relative to the other.
template <bool kIsB, class Relative>
struct BodyFrame {
  const Relative& a_from_b;

  [[nodiscard]] HWY_INLINE BodyFrame<!kIsB, Relative> opposite() const { return {a_from_b}; }
  // These lead from the other body's frame to this body's, and back.
  template <class Vector>
  [[nodiscard]] HWY_INLINE Vector point_from_other(const Vector& p) const {
    if constexpr (kIsB) return point_to_b(a_from_b, p);
    return point_to_a(a_from_b, p);
  }
  template <class Vector>
  [[nodiscard]] HWY_INLINE Vector direction_from_other(const Vector& v) const {
    if constexpr (kIsB) return direction_to_b(a_from_b, v);
    return direction_to_a(a_from_b, v);
  }
  template <class Vector>
  [[nodiscard]] HWY_INLINE Vector point_to_other(const Vector& p) const {
    return opposite().point_from_other(p);
  }
  template <class Vector>
  [[nodiscard]] HWY_INLINE Vector direction_to_other(const Vector& v) const {
    return opposite().direction_from_other(v);
  }
  // These lead from this body's frame to frame A, and back.
  template <class Vector>
  [[nodiscard]] HWY_INLINE Vector point_in_a(const Vector& p) const {
    if constexpr (kIsB) return point_to_a(a_from_b, p);
    return p;
  }
  template <class Vector>
  [[nodiscard]] HWY_INLINE Vector direction_in_a(const Vector& v) const {
    if constexpr (kIsB) return direction_to_a(a_from_b, v);
    return v;
  }
  template <class Vector>
  [[nodiscard]] HWY_INLINE Vector direction_in_local(const Vector& v) const {
    if constexpr (kIsB) return direction_to_b(a_from_b, v);
    return v;
  }

  // Sets the witness points: on this body in its own frame and in frame A, and the same for the
  // other body.
  template <class Found, class Vector>
  HWY_INLINE void place(Found& found, const Vector& local, const Vector& in_a,
                        const Vector& others_local, const Vector& others_in_a) const {
    if constexpr (kIsB) {
      found.point_a = others_in_a;
      found.local_b = local;
      found.point_b = in_a;
    } else {
      found.point_a = in_a;
      found.local_b = others_local;
      found.point_b = others_in_a;
    }
  }
};

// The plane of a facet of this body, and a point of the other body above it. `others` is the point
// in the other body's frame, `local` in this body's.
template <bool kIsB, class Relative, class Vector, class Number>
struct FacetPlane {
  HWY_INLINE FacetPlane(const Relative& pose, const Vector& normal, Number plane_offset)
      : frame{pose}, local_n(normal), n(frame.direction_in_a(normal)), offset(plane_offset) {}

  // m: the height of the point above the plane.
  [[nodiscard]] HWY_INLINE Number height(const Vector& others, const Vector& local) const {
    if constexpr (kIsB) {
      return inverse_norm_near_1(n) * dot(n, others - frame.a_from_b.translation) - offset;
    } else {
      return dot(n, local) - offset;
    }
  }
  // Sets the witness points, found.distance from each other, and the normal.
  template <class Found>
  HWY_INLINE void place_witnesses(Found& found, const Vector& others, const Vector& local) const {
    if constexpr (kIsB) {
      const Vector below = local - (dot(local_n, local) - offset) * local_n;
      frame.place(found, below, point_to_a(frame.a_from_b, below), others, others);
      found.normal = -(inverse_norm_near_1(n) * n);
    } else {
      const Vector below = local - found.distance * n;
      frame.place(found, below, below, others, local);
      found.normal = n;
    }
  }

  BodyFrame<kIsB, Relative> frame;
  Vector local_n, n;  // outward, in this body's frame and in frame A
  Number offset;      // m
};

// An edge of this body and a vertex of the other, in frame A. The rotation in doubles is not quite
// rigid, so B's unit vectors are not quite of unit length in frame A. Work in frame B instead would
// stretch A, and the error would grow with its distance.
template <bool kIsB, class Relative, class Vector, class Number>
struct EdgeAndVertex {
  HWY_INLINE EdgeAndVertex(const Relative& pose, const Vector& edge_start, const Vector& direction,
                           const Vector& vertex)
      : frame{pose},
        local_start(edge_start),
        local_e(direction),
        local_tip(vertex),
        tip(frame.opposite().point_in_a(vertex)),
        start(frame.point_in_a(edge_start)),
        e(frame.direction_in_a(direction)),
        from_start(tip - start),
        s(along_edge()) {}

  // Finds `separation`, from the edge to the vertex, by two cross products; `length` is that of the
  // first. In a difference of long vectors, cancellation would leave a part along the edge.
  HWY_INLINE void find_separation() { double_cross(from_start, e, separation, length); }
  // |separation|, computed again if cross products are too coarse: kSlender.
  [[nodiscard]] HWY_INLINE Number slender_length() const {
    if constexpr (kIsB) return norm(separation) / inverse_norm_near_1(e);
    return norm(separation);
  }
  // `of_separation`: the length by which `separation` is divided.
  template <class Found>
  HWY_INLINE void place_witnesses(Found& found, Number of_separation) const {
    if constexpr (kIsB) {
      const Number unit = inverse_norm_near_1(e);
      found.distance = found.certified = unit * length;
      found.normal = over(-(unit * separation), of_separation);
    } else {
      found.distance = found.certified = length;
      found.normal = over(separation, of_separation);
    }
    frame.place(found, local_start + s * local_e, start + s * e, local_tip, tip);
  }

  BodyFrame<kIsB, Relative> frame;
  Vector local_start, local_e, local_tip, tip, start, e, from_start;
  Number s;  // m: the vertex's place along the edge
  Vector separation;
  Number length;  // m

 private:
  [[nodiscard]] HWY_INLINE Number along_edge() const {
    if constexpr (kIsB) return dot(from_start, e) * inverse_square_near_1(e);
    return dot(from_start, e);
  }
};

// The lines of an edge of A and one of B, and the points at which they are nearest. All is in frame
// A, except the members local_...
template <class Relative, class Vector, class Number>
struct EdgeLines {
  HWY_INLINE EdgeLines(const Relative& pose, const Vector& start_of_a, const Vector& direction_of_a,
                       const Vector& start_of_b, const Vector& direction_of_b)
      : e(direction_of_a),
        local_f(direction_of_b),
        start_a(start_of_a),
        local_start_b(start_of_b),
        f(direction_to_a(pose, direction_of_b)),
        start_b(point_to_a(pose, start_of_b)),
        between(start_b - start_a),
        n(cross(e, f)),
        sine2(dot(n, n)) {}

  // Finds s along the first and t along the second line, which cross. The part of `between` along e
  // is taken off first, so that its rounding is divided by the sine and not by its square.
  HWY_INLINE void find_nearest() {
    const Number cosine = dot(e, f), along_e = dot(between, e);
    t = triple(between, e, n) / sine2;
    s = along_e + cosine * t;
  }
  template <class Found>
  HWY_INLINE void place_witnesses(Found& found) const {
    found.point_a = start_a + s * e;
    found.local_b = local_start_b + t * local_f;
    found.point_b = start_b + t * f;
  }

  // m: rounding tilts the normal. Along an edge the bodies' support values may therefore exceed the
  // computed ones by this. The radii are those of spheres around the frames' origins.
  [[nodiscard]] HWY_INLINE Number tilt_error_of_edges(const Vector& normal, Number radius_a,
                                                      Number radius_b) const {
    return number<Number>(2.0) *
           (radius_a * magnitude(dot(normal, e)) + radius_b * magnitude(dot(normal, f)));
  }

  Vector e, local_f, start_a, local_start_b, f, start_b, between, n;
  Number sine2;
  Number s, t;  // m
};

// It takes at most four transitions from two vertices to two parallel facets; more of them are a
// cycle.
inline constexpr int kMostParallel = 6;

// The first transition of a query is compiled separately. Nothing there needs the pair in memory,
// so its findings stay in registers. Otherwise boxes would cost 3 % more.
// The first one of kPlain bodies omits the cases of unbounded ones.
enum class Tracking { kFirstOfPlain, kFirst, kFurther };

// The end of one transition.
enum class Transition {
  kClosest,  // the KKT conditions are satisfied by more than rounding: the features are the closest
  kMoved,    // a neighbouring feature takes over
  kDeferred,   // a first transition leaves the features to a further one
  kUndecided,  // rounding cannot tell, or straight-line code has no case for this pair
};

using Side = TrackingState::Side;

// The pair, and the findings of the transition that ends at kClosest.
struct TrackedPair {
  HWY_INLINE TrackedPair(const ConvexBody& body_a, const ConvexBody& body_b,
                         const RelativePose4& pose, TrackingState& state, TransitionsMade at = {})
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
  Vec4 local_b;           // point_b in frame B
  Vec4 normal;            // unit, from A to B, frame A
  double distance;        // m: |point_b - point_a|; for penetrating bodies minus the depth
  // m: the distance of the polyhedra that the normal certifies, less error_bound
  double certified;
  double error_bound;  // m: Precision::error_bound
  int transitions;
  int parallel_transitions;  // those of the transitions that led to features parallel within
                             // tolerance

  bool starts_in_contact = false;  // begin() has chosen features of bodies that seem to touch

  // For penetrating bodies (core/feature_tracking/penetrating_transitions-inl.hpp):
  bool penetrating = false;
  double inradius;     // m: from the crossing of the edges to their nearest end
  double depth_error;  // m: the depth may be smaller by this
  bool touching;       // neither certainly disjoint nor certainly overlapping

  [[nodiscard]] HWY_INLINE FeaturePair features() const {
    return feature_pair(on_a.kind, on_b.kind);
  }

  // Counts a transition to parallel features: rounding may make such transitions cycle.
  [[nodiscard]] HWY_INLINE Transition parallel() {
    return ++parallel_transitions > kMostParallel ? Transition::kUndecided : Transition::kMoved;
  }
};

// Moves to the feature that takes over. A bad pose may lead to the open end of an edge, which has
// no vertex.
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

// One of the bodies, the owner of an edge or facet, with its frame; the other body has a vertex.
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
