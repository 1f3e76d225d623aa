// Penetrating bodies that part soonest between the same features as in the last query. Compiled
// once a vector width: see core/numerics/vec4-inl.hpp.
//
// Features that touch when B has been displaced along n bound the penetration depth from above, as
// separating ones bound the distance from below: with the sign turned, the transitions of
// core/feature_walk/steps-inl.hpp say how far that is. No other direction is shorter: that is
// certified by what the Minkowski difference (core/penetration/depth.hpp) contains beyond rounding.
// That is a disc across n, of radius w about the foot h n of the origin: the room that the touching
// point has on its facet; and the difference of the bodies' middles, which lies d beyond the origin
// and l beside it. Along a direction at an angle f to n the disc reaches h cos f + w sin f, at
// least h up to tan(f/2) = w/h; the middles -d cos f - l sin f at least, a sinusoid that is lowest
// at an end of what is left. It is enough that it reaches h where the disc ends.
#if defined(CLEARANCE_CORE_PENETRATING_STEPS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_PENETRATING_STEPS
#undef CLEARANCE_CORE_PENETRATING_STEPS
#else
#define CLEARANCE_CORE_PENETRATING_STEPS
#endif

#include <algorithm>
#include <cmath>

#include "core/feature_walk/steps-inl.hpp"
#include "core/model/radii.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {
// Far more than rounding does to lengths, as a part of the pair's size: by how much other
// directions are deeper need not be known any better.
inline constexpr double kAmple = 1e-9;

// How far within its facet a point of its plane lies; negative: outside.
HWY_INLINE double room_on_facet(const ConvexBody& body, const Facet& facet, Vec4 point) {
  const double* row = body.facet_limits.row(facet.first_side);
  const std::int32_t n = facet.limits;
  const Vec4 at[3] = {spread(lane(point, 0)), spread(lane(point, 1)), spread(lane(point, 2))};
  double least = kInfinity;
  for (std::int32_t i = 0; i < n; i += 4) {
    const Vec4 within = derivatives(row, n, i, at) - load4(row + 3 * n + i);
    for (std::int32_t k = 0; k < 4 && i + k < n; ++k) least = std::min(least, lane(within, k));
  }
  return least;
}

// Of the features that touch: the disc's radius.
HWY_INLINE double room_of(const TrackedPair& pair) {
  double room = pair.room;
  if (pair.on_a.kind == FeatureKind::kFacet) {
    room = std::max(room, room_on_facet(pair.a, pair.a.facets[pair.on_a.feature], pair.point_a));
  }
  if (pair.on_b.kind == FeatureKind::kFacet) {
    room = std::max(room, room_on_facet(pair.b, pair.b.facets[pair.on_b.feature], pair.own_b));
  }
  return room;
}

// Edges that cross, each within the other body.
HWY_INLINE Transition penetrating_edges(TrackedPair& pair) {
  if (!pair.a.bounded() || !pair.b.bounded()) return Transition::kUndecided;
  const Edge& first = pair.a.edges[pair.on_a.feature];
  const Edge& second = pair.b.edges[pair.on_b.feature];
  auto lines = lines_of(pair, first, second);
  if (!(lines.sine2 > kCrossingSine2)) return Transition::kUndecided;
  lines.find_nearest();
  const double s = lines.s, t = lines.t;
  const double to_end = std::min(std::min(s, first.end - s), std::min(t, second.end - t));
  const double sine = std::sqrt(lines.sine2), limit = -kDerivativeError * sine,
               across = dot(lines.between, lines.n);
  const Vec4 g = with_signs(lines.n, spread(std::copysign(0.0, -across)));
  const Vec4 back = -direction_to_b(pair.a_from_b, g);
  if (!(to_end > 0.0) || !both_facets_recede(first, g, limit) ||
      !both_facets_recede(second, back, limit)) {
    return Transition::kUndecided;
  }
  pair.normal = over(g, sine);
  lines.place_witnesses(pair);
  pair.apart = -std::abs(across) / sine;
  pair.room = to_end * sine;
  // As far as the normal may be tilted, the edges' own plane is nearer, too.
  const double tilt =
      lines.reach_of_tilt(pair.normal, pair.a.bounding_radius, pair.b.bounding_radius);
  pair.certified = pair.apart - tilt;
  pair.beyond = tilt;
  return Transition::kClosest;
}

HWY_INLINE Transition penetrating_transition(TrackedPair& pair) {
  pair.room = pair.beyond = 0.0;
  switch (pair.features()) {
    case FeaturePair::kVertexVertex:
    case FeaturePair::kVertexEdge:
    case FeaturePair::kEdgeVertex:
      return Transition::kUndecided;  // no plane parts the bodies there
    case FeaturePair::kEdgeEdge:
      return penetrating_edges(pair);
    default:
      return transition<Tracking::kFurther>(pair);
  }
}

// Is the displacement along every other direction longer?
HWY_INLINE bool is_shortest(const TrackedPair& pair, double size) {
  const Vec4 middles = point_to_a(pair.a_from_b, load3(pair.b.interior)) - load3(pair.a.interior);
  const double along = dot(middles, pair.normal), off = kAmple * size;
  const double height = off - pair.apart, radius = room_of(pair) - off, d = along - off;
  const double l = off + norm(middles - along * pair.normal), k = height / radius;
  return radius > height && d * (1.0 - k * k) - 2.0 * k * l > height * (1.0 + k * k);
}

HWY_INLINE bool certify_penetration(TrackedPair& pair) {
  const RelativePose4& pose = pair.a_from_b;
  const PlacePrecision place{pose.rotation_error, pose.translation_error, pose.apart};
  const Precision p = precision(pair.a, pair.b, place, std::abs(pair.apart));
  pair.error_bound = p.error_bound;
  const bool certified =
      pair.apart > 0.0 ? pair.certified > p.error_bound
                       : pair.apart + pair.beyond < -p.error_bound && is_shortest(pair, p.size);
  const double noise = pair.apart - pair.certified;
  const double gap = noise + pair.beyond + 2.0 * p.error_bound;
  if (!certified || !(noise <= p.gap_tolerance) ||
      !is_as_promised(pair.a, pair.b, p.size, pair.apart, gap)) {
    return false;
  }
  pair.on_a.penetrating = !(pair.apart > 0.0);
  pair.on_a.point = vec3(pair.point_a);
  pair.on_b.point = vec3(pair.own_b);
  return true;
}

// Of bodies that penetrated each other: is their depth certified, or that they do not any more? If
// not, the features are those that it began with.
HWY_INLINE bool walk_penetration(TrackedPair& pair) {
  if (!pair.a.bounded() && !pair.b.bounded()) return false;
  if (!exists(pair.a, pair.on_a) || !exists(pair.b, pair.on_b)) return false;
  const Side before_a = pair.on_a, before_b = pair.on_b;
  pair.penetrating = true;
  Transition result = Transition::kMoved;
  while (result == Transition::kMoved && pair.transitions < kMostTransitions) {
    ++pair.transitions;
    result = penetrating_transition(pair);
  }
  if (result == Transition::kClosest && certify_penetration(pair)) return true;
  pair.on_a = before_a;
  pair.on_b = before_b;
  return false;
}

// Of a walk that has certified something.
HWY_INLINE DistanceResult penetration_result_of(const TrackedPair& pair) {
  DistanceResult r = result_of(pair);
  r.path = DistancePath::kPenetration;
  if (pair.apart > 0.0) return r;
  r.upper = (pair.apart + pair.beyond) + pair.error_bound;
  r.status = DistanceStatus::kOverlapping;
  return r;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
