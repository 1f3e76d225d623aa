// Transitions of penetrating bodies whose depth is between the same features as in the last query,
// or their neighbours. Compiled once a vector width: see core/numerics/vec4-inl.hpp.
//
// Let h be the displacement of B along n after which the features touch. It bounds the penetration
// depth from above, as separating features bound the distance from below. The transitions of
// transitions-inl.hpp, with the sign reversed, find h.
//
// No other direction is shorter. This follows from two sets that the Minkowski difference
// (core/penetration/depth.hpp) contains by more than rounding:
// - A disc across n, of radius w around the point h n. w is the inradius of the contact: the
// distance of the touching point from the sides of its facet.
// - The difference of the two interior points, at -d along n and l across it.
//
// Consider a direction at an angle f to n. The support value of the disc is h cos f + w sin f. It
// is at least h up to tan(f/2) = w/h. The support value of the interior points is at least -d cos f
// - l sin f. This sinusoid is lowest at one end of the other angles. So it is enough that it is at
// least h at tan(f/2) = w/h.
#if defined(CLEARANCE_CORE_PENETRATING_TRANSITIONS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_PENETRATING_TRANSITIONS
#undef CLEARANCE_CORE_PENETRATING_TRANSITIONS
#else
#define CLEARANCE_CORE_PENETRATING_TRANSITIONS
#endif

#include <algorithm>
#include <cmath>

#include "core/feature_tracking/contact_transitions-inl.hpp"
#include "core/model/radii.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {
// A margin far above rounding, as a part of the pair's size. The test only has to show whether
// other directions are longer by this margin.
inline constexpr double kAmple = 1e-9;

// The distance of a point of a facet's plane from the sides of the facet; negative: outside.
HWY_INLINE double inradius_on_facet(const ConvexBody& body, const Facet& facet, Vec4 point) {
  const double* four = body.facet_limits.row(facet.first_side);
  const Spread3 at(point);
  double least = kInfinity;
  for (std::int32_t i = 0; i < facet.limits; i += 4, four += kFourLimits) {
    const Vec4 inside = inside_limits(four, at);
    for (std::int32_t k = 0; k < 4; ++k) least = std::min(least, lane(inside, k));
  }
  return least;
}

// The radius of the disc, from the features that touch.
HWY_INLINE double contact_inradius(const TrackedPair& pair) {
  double inradius = pair.inradius;
  if (pair.on_a.kind == FeatureKind::kFacet) {
    inradius = std::max(inradius,
                        inradius_on_facet(pair.a, pair.a.facets[pair.on_a.feature], pair.point_a));
  }
  if (pair.on_b.kind == FeatureKind::kFacet) {
    inradius = std::max(inradius,
                        inradius_on_facet(pair.b, pair.b.facets[pair.on_b.feature], pair.local_b));
  }
  return inradius;
}

// Edges that cross, each within the other body or touching it. The facets beside them decide on
// which side of A's edge B's is, because the lines may be closer than rounding.
HWY_INLINE Transition penetrating_edges(TrackedPair& pair) {
  if (!pair.a.bounded() || !pair.b.bounded()) return Transition::kUndecided;
  const Edge& first = pair.a.edges[pair.on_a.feature];
  const Edge& second = pair.b.edges[pair.on_b.feature];
  auto lines = lines_of(pair, first, second);
  if (!(lines.sine2 > kCrossingSine2)) return disjoint_transition(pair);
  lines.find_nearest();
  const double s = lines.s, t = lines.t;
  const double to_end = std::min(std::min(s, first.end - s), std::min(t, second.end - t));
  const double sine = std::sqrt(lines.sine2), limit = -kDerivativeError * sine,
               across = std::abs(dot(lines.between, lines.n));
  const double size = size_of(pair);
  const bool near = across <= kNearContact * size * sine;
  Vec4 g = with_signs(lines.n, spread(std::copysign(0.0, -dot(lines.between, lines.n))));
  const auto is_closest = [&] HWY_ATTR {
    return to_end > 0.0 && both_facets_recede(first, g, limit) &&
           both_facets_recede(second, -direction_to_b(pair.a_from_b, g), limit);
  };
  const bool overlap = is_closest();
  if (!overlap) {
    g = -g;
    if (!near) return Transition::kUndecided;
    if (!is_closest()) return disjoint_transition(pair);
  }
  pair.normal = over(g, sine);
  lines.place_witnesses(pair);
  const double between = norm(pair.point_b - pair.point_a), length = across / sine;
  pair.distance = overlap ? -length : between;
  pair.inradius = to_end * sine;
  // The exact plane of the edges may also be nearer by the tilt of the normal.
  const double tilt =
      lines.tilt_error_of_edges(pair.normal, pair.a.bounding_radius, pair.b.bounding_radius);
  pair.certified = (overlap ? -length : length) - tilt;
  pair.depth_error = tilt;
  // The points of edges that touch are not exactly along the normal.
  if (length <= kMayTouch * size) pair.depth_error += std::max(0.0, between - length);
  return Transition::kClosest;
}

HWY_INLINE Transition penetrating_transition(TrackedPair& pair) {
  pair.inradius = pair.depth_error = 0.0;
  switch (pair.features()) {
    case FeaturePair::kVertexVertex:
      return touching_vertices(pair);
    case FeaturePair::kVertexEdge:
      return touching_edge(Owner<true>(pair));
    case FeaturePair::kEdgeVertex:
      return touching_edge(Owner<false>(pair));
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
  const double height = off - pair.distance, radius = contact_inradius(pair) - off, d = along - off;
  const double l = off + norm(middles - along * pair.normal), k = height / radius;
  return radius > height && d * (1.0 - k * k) - 2.0 * k * l > height * (1.0 + k * k);
}

HWY_INLINE bool are_facets_of_boxes(const TrackedPair& pair) {
  return pair.features() == FeaturePair::kFacetFacet && pair.a.box.exist() && pair.b.box.exist();
}

// The same for parallel facets of two boxes. A - B is a prism over a polygon whose sides are
// across the boxes' other axes. So the displacement is the shortest if those along these axes and
// past the opposite facets are longer.
inline HWY_NOINLINE bool is_shortest_of_boxes(const TrackedPair& pair, double size) {
  const BoxFeatures &a = pair.a.box, &b = pair.b.box;
  const auto magnitude = [](Vec4 v) HWY_ATTR { return where_less(v, spread(0.0), -v, v); };
  const auto magnitudes = [&](const Diagonals& m) HWY_ATTR {
    return Diagonals{magnitude(m.main), magnitude(m.next), magnitude(m.last)};
  };
  const Diagonals to_a = magnitudes(pair.a_from_b.rotation);
  const Diagonals to_b = magnitudes(pair.a_from_b.transposed);
  const Vec4 half_a = load3_of_4(a.half), half_b = load3_of_4(b.half);
  const Vec4 between = point_to_a(pair.a_from_b, load3_of_4(b.centre)) - load3_of_4(a.centre);
  const Vec4 gaps_a = magnitude(between) - (half_a + to_a * half_b);
  const Vec4 gaps_b = magnitude(direction_to_b(pair.a_from_b, between)) - (half_b + to_b * half_a);
  const auto all_others_longer = [&](Vec4 gaps, const Facet& facet) HWY_ATTR {
    const Vec4 n = load3_of_4(facet.normal), limit = spread(pair.distance - kAmple * size);
    return ((less(gaps, limit) | less(spread(0.5), n * n)) & 7u) == 7u;
  };
  const Vec4 n = load3_of_4(pair.a.facets[pair.on_a.feature].normal);
  return dot(n, between) > kAmple * size &&
         all_others_longer(gaps_a, pair.a.facets[pair.on_a.feature]) &&
         all_others_longer(gaps_b, pair.b.facets[pair.on_b.feature]);
}

// The features meet within rounding, so the bodies are neither certainly disjoint nor certainly
// overlapping. The plane of the features bounds the distance from below, as for all bodies. The
// points on them are points of the bodies, so their distance bounds it from above.
HWY_INLINE bool is_contact(const TrackedPair& pair, const Precision& p) {
  const double between = std::abs(pair.distance);
  const double gap = between - pair.certified + pair.depth_error;
  return between <= p.error_bound && gap <= 0.5 * p.error_bound + 5.0 * p.gap_tolerance;
}

template <bool kBounded = false>
HWY_INLINE bool certify_penetration(TrackedPair& pair) {
  const RelativePose4& pose = pair.a_from_b;
  const PlacePrecision place{pose.rotation_error, pose.translation_error, pose.translation_length};
  const Precision p = precision<kBounded>(pair.a, pair.b, place, std::abs(pair.distance));
  pair.error_bound = p.error_bound;
  pair.touching = is_contact(pair, p);
  if (!pair.touching) {
    const double noise = pair.distance - pair.certified;
    // A tilt of the facets counts for a prism's height, too.
    if (are_facets_of_boxes(pair)) pair.depth_error = noise;
    const bool certified =
        pair.distance > 0.0
            ? pair.certified > p.error_bound
            : pair.distance + pair.depth_error < -p.error_bound &&
                  (is_shortest(pair, p.size) ||
                   (are_facets_of_boxes(pair) && is_shortest_of_boxes(pair, p.size)));
    const double gap = noise + pair.depth_error + 2.0 * p.error_bound;
    if (!certified || !(noise <= p.gap_tolerance) ||
        !converges_with_radii(pair.a, pair.b, p.size, pair.distance, gap)) {
      return false;
    }
  }
  pair.on_a.penetrating = pair.touching || !(pair.distance > 0.0);
  pair.on_a.point = vec3(pair.point_a);
  pair.on_b.point = vec3(pair.local_b);
  return true;
}

// Tracks the features of bodies that touched or penetrated each other. True: the depth is
// certified, or the bodies are certified to touch or to be disjoint now. False: the features are
// unchanged.
HWY_INLINE bool track_penetrating_features(TrackedPair& pair) {
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

// The result of tracking that has certified the depth, a contact or the distance.
HWY_INLINE DistanceResult penetration_result_of(const TrackedPair& pair) {
  DistanceResult r = result_of(pair);
  r.path = DistancePath::kPenetration;
  if (pair.touching) {
    r.upper = (std::abs(pair.distance) + pair.depth_error) + pair.error_bound;
    if (!(r.lower > 0.0)) r.status = DistanceStatus::kTouching;
    return r;
  }
  if (pair.distance > 0.0) return r;
  r.upper = (pair.distance + pair.depth_error) + pair.error_bound;
  r.status = DistanceStatus::kOverlapping;
  return r;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
