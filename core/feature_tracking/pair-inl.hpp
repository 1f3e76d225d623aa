// A pair of bodies and the features that may be closest: their geometry in straight-line
// arithmetic, and TrackedPair, which keeps the results. The decisions of a transition are in
// core/feature_tracking/transitions-inl.hpp. Compiled once per vector width: see
// core/numerics/vec4-inl.hpp.
#if defined(CLEARANCE_CORE_TRACKED_PAIR) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_TRACKED_PAIR
#undef CLEARANCE_CORE_TRACKED_PAIR
#else
#define CLEARANCE_CORE_TRACKED_PAIR
#endif

#include <cassert>
#include <cmath>

#include "core/feature_tracking/feature_pair.hpp"
#include "core/feature_tracking/feature_tracking.hpp"
#include "core/model/error_bounds.hpp"
#include "core/model/relative_pose-inl.hpp"
#include "core/model/result_invariants.hpp"
#include "core/model/result_numbers.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// 1/|v| and 1/|v|^2 of a vector whose length is 1 up to some roundings: one Newton step for
// x^(-1/2), and for 1/x, from 1. The error is of second order.
HWY_INLINE double inverse_norm_near_1(Vec4 v) { return 1.5 - 0.5 * dot(v, v); }
HWY_INLINE double inverse_square_near_1(Vec4 v) { return 2.0 - dot(v, v); }

// The closest points, set by the transition that ends at kClosest.
struct Findings {
  // The witness points: A's in frame A, and B's in frame A and in frame B. g++ 12 does not see that
  // the last one is set wherever it is read, and g++ 13 does not see it of the first one.
  Vec4 a_A{}, b_A, b_B{};
  Vec4 n_A;               // the normal: unit, from A to B, frame A
  double distance = 0.0;  // m: |b_A - a_A|; for penetrating bodies minus the depth
  // m: the distance of the polyhedra that the normal certifies, less error_bound
  double certified = 0.0;
  double error_bound = 0.0;  // m: Precision::error_bound
};

// One of the bodies, A or B, and its pose relative to the other. Names end in the frame: _A, _B, _L
// (local: this body's) or _O (the other body's).
template <bool kIsB>
struct BodyFrame {
  const RelativePose4& a_from_b;

  [[nodiscard]] HWY_INLINE BodyFrame<!kIsB> opposite() const { return {a_from_b}; }
  // These lead from the other body's frame to this body's, and back.
  [[nodiscard]] HWY_INLINE Vec4 point_O_to_L(Vec4 p) const {
    if constexpr (kIsB) return point_to_b(a_from_b, p);
    return point_to_a(a_from_b, p);
  }
  [[nodiscard]] HWY_INLINE Vec4 direction_O_to_L(Vec4 v) const {
    if constexpr (kIsB) return direction_to_b(a_from_b, v);
    return direction_to_a(a_from_b, v);
  }
  [[nodiscard]] HWY_INLINE Vec4 point_L_to_O(Vec4 p) const { return opposite().point_O_to_L(p); }
  [[nodiscard]] HWY_INLINE Vec4 direction_L_to_O(Vec4 v) const {
    return opposite().direction_O_to_L(v);
  }
  // These lead from this body's frame to frame A, and back.
  [[nodiscard]] HWY_INLINE Vec4 point_L_to_A(Vec4 p) const {
    if constexpr (kIsB) return point_to_a(a_from_b, p);
    return p;
  }
  [[nodiscard]] HWY_INLINE Vec4 direction_L_to_A(Vec4 v) const {
    if constexpr (kIsB) return direction_to_a(a_from_b, v);
    return v;
  }
  [[nodiscard]] HWY_INLINE Vec4 direction_A_to_L(Vec4 v) const {
    if constexpr (kIsB) return direction_to_b(a_from_b, v);
    return v;
  }

  // Sets the witness points: on this body in its own frame and in frame A, and the same for the
  // other body.
  HWY_INLINE void place(Findings& found, Vec4 local, Vec4 in_a, Vec4 others_local,
                        Vec4 others_in_a) const {
    if constexpr (kIsB) {
      found.a_A = others_in_a;
      found.b_B = local;
      found.b_A = in_a;
    } else {
      found.a_A = in_a;
      found.b_B = others_local;
      found.b_A = others_in_a;
    }
  }
};

// The plane of a facet of this body, and a point of the other body above it. `others` is the point
// in the other body's frame, `local` in this body's.
template <bool kIsB>
struct FacetPlane {
  HWY_INLINE FacetPlane(const RelativePose4& pose, Vec4 normal, double plane_offset)
      : frame{pose}, n_L(normal), n_A(frame.direction_L_to_A(normal)), offset(plane_offset) {}

  // m: the height of the point above the plane.
  [[nodiscard]] HWY_INLINE double height(Vec4 p_O, Vec4 p_L) const {
    if constexpr (kIsB) {
      return inverse_norm_near_1(n_A) * dot(n_A, p_O - frame.a_from_b.translation) - offset;
    } else {
      return dot(n_A, p_L) - offset;
    }
  }
  // Sets the witness points, found.distance from each other, and the normal.
  HWY_INLINE void place_witnesses(Findings& found, Vec4 p_O, Vec4 p_L) const {
    if constexpr (kIsB) {
      const Vec4 below_L = p_L - (dot(n_L, p_L) - offset) * n_L;
      frame.place(found, below_L, point_to_a(frame.a_from_b, below_L), p_O, p_O);
      found.n_A = -(inverse_norm_near_1(n_A) * n_A);
    } else {
      const Vec4 below_L = p_L - found.distance * n_A;
      frame.place(found, below_L, below_L, p_O, p_L);
      found.n_A = n_A;
    }
  }

  BodyFrame<kIsB> frame;
  Vec4 n_L, n_A;  // outward, in this body's frame and in frame A
  double offset;  // m
};

// An edge of this body and a vertex of the other, in frame A. The rotation in doubles is not quite
// rigid, so B's unit vectors are not quite of unit length in frame A. Work in frame B instead would
// stretch A, and the error would grow with its distance.
template <bool kIsB>
struct EdgeAndVertex {
  HWY_INLINE EdgeAndVertex(const RelativePose4& pose, Vec4 edge_start, Vec4 direction, Vec4 vertex)
      : frame{pose},
        start_L(edge_start),
        e_L(direction),
        tip_O(vertex),
        tip_A(frame.opposite().point_L_to_A(vertex)),
        start_A(frame.point_L_to_A(edge_start)),
        e_A(frame.direction_L_to_A(direction)),
        from_start_A(tip_A - start_A),
        s(along_edge()) {}

  // Finds the vector from the edge to the vertex by two cross products; `length` is that of the
  // first. In a difference of long vectors, cancellation would leave a part along the edge.
  HWY_INLINE void find_separation() { double_cross(from_start_A, e_A, separation_A, length); }
  // |separation_A|, computed again if cross products are too coarse: kSlender.
  [[nodiscard]] HWY_INLINE double slender_length() const {
    if constexpr (kIsB) return norm(separation_A) / inverse_norm_near_1(e_A);
    return norm(separation_A);
  }
  // `of_separation`: the length by which `separation_A` is divided.
  HWY_INLINE void place_witnesses(Findings& found, double of_separation) const {
    if constexpr (kIsB) {
      const double unit = inverse_norm_near_1(e_A);
      found.distance = found.certified = unit * length;
      found.n_A = over(-(unit * separation_A), of_separation);
    } else {
      found.distance = found.certified = length;
      found.n_A = over(separation_A, of_separation);
    }
    frame.place(found, start_L + s * e_L, start_A + s * e_A, tip_O, tip_A);
  }

  BodyFrame<kIsB> frame;
  Vec4 start_L, e_L, tip_O, tip_A, start_A, e_A, from_start_A;
  double s;  // m: the vertex's place along the edge
  Vec4 separation_A;
  double length;  // m

 private:
  [[nodiscard]] HWY_INLINE double along_edge() const {
    if constexpr (kIsB) return dot(from_start_A, e_A) * inverse_square_near_1(e_A);
    return dot(from_start_A, e_A);
  }
};

// The lines of an edge of A and one of B, and the points at which they are nearest. Names
// end in the frame.
struct EdgeLines {
  HWY_INLINE EdgeLines(const RelativePose4& pose, Vec4 start_of_a, Vec4 direction_of_a,
                       Vec4 start_of_b, Vec4 direction_of_b)
      : e_A(direction_of_a),
        f_B(direction_of_b),
        start_a_A(start_of_a),
        start_b_B(start_of_b),
        f_A(direction_to_a(pose, direction_of_b)),
        start_b_A(point_to_a(pose, start_of_b)),
        between_A(start_b_A - start_a_A),
        n_A(cross(e_A, f_A)),
        sine2(dot(n_A, n_A)) {}

  // Finds s along the first and t along the second line, which cross. The part along e_A is taken
  // off first, so that its rounding is divided by the sine and not by its square.
  HWY_INLINE void find_nearest() {
    const double cosine = dot(e_A, f_A), along_e = dot(between_A, e_A);
    t = triple(between_A, e_A, n_A) / sine2;
    s = along_e + cosine * t;
  }
  HWY_INLINE void place_witnesses(Findings& found) const {
    found.a_A = start_a_A + s * e_A;
    found.b_B = start_b_B + t * f_B;
    found.b_A = start_b_A + t * f_A;
  }

  // m: rounding tilts the normal. Along an edge the bodies' support values may therefore exceed the
  // computed ones by this. The radii are those of spheres around the frames' origins.
  [[nodiscard]] HWY_INLINE double tilt_error_of_edges(Vec4 normal, double radius_a,
                                                      double radius_b) const {
    return 2.0 * (radius_a * std::abs(dot(normal, e_A)) + radius_b * std::abs(dot(normal, f_A)));
  }

  Vec4 e_A, f_B, start_a_A, start_b_B, f_A, start_b_A, between_A, n_A;
  double sine2;
  double s, t;  // m
};

// A pair takes at most four transitions from two vertices to two parallel facets; more of them are
// a cycle.
inline constexpr int kMostParallel = 6;

// The end of one transition.
enum class Transition {
  kClosest,  // the KKT conditions are satisfied by more than rounding: the features are the closest
  kMoved,    // a neighbouring feature takes over
  kUndecided,  // rounding cannot tell, or straight-line code has no case for this pair
};

using Side = TrackingState::Side;

// The contact of bodies that touch or penetrate each other (penetrating_transitions-inl.hpp).
struct Contact {
  double inradius = 0.0;     // m: from the crossing of the edges to their nearest end
  double depth_error = 0.0;  // m: the depth may be smaller by this
  bool touching = false;     // neither certainly disjoint nor certainly overlapping
};

struct TransitionsMade {
  int all = 0;
  int parallel = 0;  // those that led to features parallel within tolerance
};

struct TrackedPair {
  HWY_INLINE explicit TrackedPair(const Query4& query, TransitionsMade made_before = {})
      : a(query.a),
        b(query.b),
        a_from_b(query.a_from_b),
        on_a(query.state.a),
        on_b(query.state.b),
        made(made_before) {}

  const ConvexBody& a;
  const ConvexBody& b;
  const RelativePose4& a_from_b;
  Side& on_a;
  Side& on_b;
  TransitionsMade made;
  bool penetrating = false;  // the features may lie behind each other
  Findings found;
  Contact contact;

  [[nodiscard]] HWY_INLINE FeaturePair features() const {
    return feature_pair(on_a.kind, on_b.kind);
  }

  // Counts a transition to parallel features: rounding may make such transitions cycle.
  [[nodiscard]] HWY_INLINE Transition parallel() {
    return ++made.parallel > kMostParallel ? Transition::kUndecided : Transition::kMoved;
  }
};

HWY_INLINE double size_of(const TrackedPair& pair) {
  return size_of(pair.a, pair.b, pair.a_from_b.translation_length);
}

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
struct Owner : BodyFrame<kIsB> {
  HWY_INLINE explicit Owner(TrackedPair& of) : BodyFrame<kIsB>{of.a_from_b}, pair(of) {}

  [[nodiscard]] HWY_INLINE const ConvexBody& body() const { return kIsB ? pair.b : pair.a; }
  [[nodiscard]] HWY_INLINE const ConvexBody& other_body() const { return kIsB ? pair.a : pair.b; }
  [[nodiscard]] HWY_INLINE Side& side() const { return kIsB ? pair.on_b : pair.on_a; }
  [[nodiscard]] HWY_INLINE Side& other_side() const { return kIsB ? pair.on_a : pair.on_b; }

  TrackedPair& pair;
};

template <bool kIsB>
HWY_INLINE FacetPlane<kIsB> plane_of(const BodyFrame<kIsB>& frame, const Facet& facet) {
  return {frame.a_from_b, load3_padded(facet.normal), facet.offset};
}

// Below this distance, m, squares of coordinates underflow: a normal then is not of unit length,
// and the error bound, which is larger, holds alone.
inline constexpr double kLeastWithNormal = 1e-150;

// The certificate of the closest features. Their distance bounds that of the bodies from above, and
// `certified` bounds it from below, both up to the error bound of Precision.
HWY_INLINE TrackingEnd certify(TrackedPair& pair) {
  const Precision p = precision(pair.a, pair.b, place_of(pair.a_from_b), pair.found.distance);
  const Findings& found = pair.found;
  assert(found.distance < kLeastWithNormal ||
         (is_unit_or_unknown(vec3(found.n_A)) && !(found.certified > found.distance + p.size)));
  pair.found.error_bound = p.error_bound;
  pair.on_a.point = vec3(found.a_A);
  pair.on_b.point = vec3(found.b_B);
  const bool certified =
      found.certified > p.error_bound && found.distance - found.certified <= p.gap_tolerance;
  return certified ? TrackingEnd::kCertified : TrackingEnd::kUncertified;
}

// The answer of a tracking that is not undecided. Each store of four numbers writes one too many,
// which the next store overwrites. The status overwrites the last one.
HWY_INLINE void write(const TrackedPair& pair, Answer& answer) {
  const Findings& found = pair.found;
  store4(vec4(found.distance, found.certified - found.error_bound,
              found.distance + found.error_bound, 0.0),
         number_at(answer, 0));
  store4(found.n_A, number_at(answer, 3));
  store4(found.a_A, number_at(answer, 6));
  store4(found.b_A, number_at(answer, 9));
  answer.status = DistanceStatus::kConverged;
  answer.path = DistancePath::kFeatureTracking;
  answer.iterations = static_cast<std::uint16_t>(pair.made.all);
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
