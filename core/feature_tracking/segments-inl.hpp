// The closest features of two bodies that are points or segments: spheres and capsules without
// their radii. Compiled once per vector width: see core/numerics/vec4-inl.hpp.
//
// The squared distance of x(s) = p + s e and y(t) = q + t f, with unit e and f, is a convex
// quadratic function of s and t. Its minimum over the rectangle of both segments follows by three
// clamps (V. J. Lumelsky, Inf. Process. Lett. 21, 1985; C. Ericson, Real-Time Collision
// Detection, 5.1.9). A clamped parameter stands for an end, any other for the edge. A point is a
// segment of length 0.
#if defined(CLEARANCE_CORE_SEGMENTS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_SEGMENTS
#undef CLEARANCE_CORE_SEGMENTS
#else
#define CLEARANCE_CORE_SEGMENTS
#endif

#include <algorithm>

#include "core/feature_tracking/pair-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

HWY_INLINE bool are_segments(const ConvexBody& a, const ConvexBody& b) {
  return a.is_thin() && b.is_thin();
}

// Two points, whatever their state holds. False: rounding cannot tell their distance from 0.
HWY_INLINE bool between_points(const Query4& q, Answer& answer) {
  for (Side* side : {&q.state.a, &q.state.b}) {
    side->kind = FeatureKind::kVertex;
    side->penetrating = false;
    side->feature = 0;
  }
  TrackedPair pair(q);
  ++pair.made.all;
  Findings& found = pair.found;
  found.a_A = load3_masked(q.a.vertices[0].position);
  found.b_B = load3_masked(q.b.vertices[0].position);
  found.b_A = point_to_a(q.a_from_b, found.b_B);
  const Vec4 between = found.b_A - found.a_A;
  found.distance = found.certified = norm(between);
  found.n_A = over(between, found.distance);
  if (HWY_UNLIKELY(certify(pair) != TrackingEnd::kCertified)) return false;
  write(pair, answer);
  return true;
}

// In the body's frame.
struct Segment {
  Vec4 start, direction;  // of a point: 0
  double length;          // m
};
HWY_INLINE Segment segment_of(const ConvexBody& body) {
  if (body.features[1] == 0) return {load3_masked(body.vertices[0].position), spread(0.0), 0.0};
  const Edge& edge = body.edges[0];
  return {load3_padded(edge.point), load3_padded(edge.direction), edge.end};
}

// Branches, not selections: the queries that follow need not wait for the features.
HWY_INLINE double to_place_on_segment(Side& side, double s, double length) {
  if (s > 0.0) {
    if (s < length) {
      side.kind = FeatureKind::kEdge;
      side.feature = 0;
      return s;
    }
    side.kind = FeatureKind::kVertex;
    side.feature = 1;
    return length;
  }
  side.kind = FeatureKind::kVertex;
  side.feature = 0;
  return 0.0;
}

// A hint, as any features are: the certificate decides. Parallel segments may have several closest
// features; the search then starts at their edges.
HWY_INLINE void start_at_segments(const Query4& q) {
  assert(are_segments(q.a, q.b));
  const Segment a = segment_of(q.a), b = segment_of(q.b);
  const RelativePose4& a_from_b = q.a_from_b;
  TrackingState& state = q.state;
  double s = 0.0, t = 0.0;
  const Vec4 between = point_to_a(a_from_b, b.start) - a.start;
  if (b.length == 0.0) {
    to_place_on_segment(state.b, 0.0, 0.0);
    s = dot(between, a.direction);  // 0 if A is a point, too
    to_place_on_segment(state.a, s, a.length);
    return;
  }
  const Vec4 f = direction_to_a(a_from_b, b.direction);
  if (a.length == 0.0) {
    to_place_on_segment(state.a, 0.0, 0.0);
    to_place_on_segment(state.b, -dot(between, f), b.length);
    return;
  }
  const double cosine = dot(a.direction, f), along_e = dot(between, a.direction),
               along_f = dot(between, f);
  const double sine2 = 1.0 - cosine * cosine;
  s = to_place_on_segment(state.a, (along_e - cosine * along_f) / sine2, a.length);
  const double free_t = cosine * s - along_f;
  t = to_place_on_segment(state.b, free_t, b.length);
  if (t != free_t) to_place_on_segment(state.a, along_e + cosine * t, a.length);
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
