// Transitions of penetrating bodies whose depth is between the same features as in the last query,
// or their neighbours. Compiled once per vector width: see core/numerics/vec4-inl.hpp.
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
  double inradius = pair.contact.inradius;
  if (pair.on_a.kind == FeatureKind::kFacet) {
    inradius = std::max(
        inradius, inradius_on_facet(pair.a, pair.a.facets[pair.on_a.feature], pair.found.a_A));
  }
  if (pair.on_b.kind == FeatureKind::kFacet) {
    inradius = std::max(
        inradius, inradius_on_facet(pair.b, pair.b.facets[pair.on_b.feature], pair.found.b_B));
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
               across = std::abs(dot(lines.between_A, lines.n_A));
  const double size = size_of(pair);
  const bool near = across <= kNearContact * size * sine;
  Vec4 g = with_signs(lines.n_A, spread(std::copysign(0.0, -dot(lines.between_A, lines.n_A))));
  const auto is_closest = [&]() HWY_ATTR {
    return to_end > 0.0 && both_facets_recede(first, g, limit) &&
           both_facets_recede(second, -direction_to_b(pair.a_from_b, g), limit);
  };
  const bool overlap = is_closest();
  if (!overlap) {
    g = -g;
    if (!near) return Transition::kUndecided;
    if (!is_closest()) return disjoint_transition(pair);
  }
  pair.found.n_A = over(g, sine);
  lines.place_witnesses(pair.found);
  const double between = norm(pair.found.b_A - pair.found.a_A), length = across / sine;
  pair.found.distance = overlap ? -length : between;
  pair.contact.inradius = to_end * sine;
  // The exact plane of the edges may also be nearer by the tilt of the normal.
  const double tilt =
      lines.tilt_error_of_edges(pair.found.n_A, pair.a.bounding_radius, pair.b.bounding_radius);
  pair.found.certified = (overlap ? -length : length) - tilt;
  pair.contact.depth_error = tilt;
  // The points of edges that touch are not exactly along the normal.
  if (length <= kMayTouch * size) pair.contact.depth_error += std::max(0.0, between - length);
  return Transition::kClosest;
}

HWY_INLINE Transition penetrating_transition(TrackedPair& pair) {
  pair.contact = {};
  switch (pair.features()) {
    case FeaturePair::kVertexVertex:
      return touching_vertices(pair);
    case FeaturePair::kVertexEdge:
      return touching_edge(Owner<true>(pair));
    case FeaturePair::kEdgeVertex:
      return touching_edge(Owner<false>(pair));
    case FeaturePair::kEdgeEdge:
      return penetrating_edges(pair);
    case FeaturePair::kFacetFacet:
      return facet_facet(pair);
    default:
      return disjoint_transition(pair);
  }
}

// Is the displacement along every other direction longer?
HWY_INLINE bool is_shortest(const TrackedPair& pair, double size) {
  const Vec4 middles = point_to_a(pair.a_from_b, load3(pair.b.interior)) - load3(pair.a.interior);
  const double along = dot(middles, pair.found.n_A), off = kAmple * size;
  const double height = off - pair.found.distance, radius = contact_inradius(pair) - off,
               d = along - off;
  const double l = off + norm(middles - along * pair.found.n_A), k = height / radius;
  return radius > height && d * (1.0 - k * k) - 2.0 * k * l > height * (1.0 + k * k);
}

// The features meet within rounding, so the bodies are neither certainly disjoint nor certainly
// overlapping. The plane of the features bounds the distance from below, as for all bodies. The
// points on them are points of the bodies, so their distance bounds it from above.
HWY_INLINE bool is_contact(const TrackedPair& pair, const Precision& p) {
  const double between = std::abs(pair.found.distance);
  const double gap = between - pair.found.certified + pair.contact.depth_error;
  return between <= p.error_bound && gap <= 0.5 * p.error_bound + 5.0 * p.gap_tolerance;
}

HWY_INLINE bool certify_penetration(TrackedPair& pair) {
  const Precision p =
      precision(pair.a, pair.b, place_of(pair.a_from_b), std::abs(pair.found.distance));
  pair.found.error_bound = p.error_bound;
  pair.contact.touching = is_contact(pair, p);
  if (!pair.contact.touching) {
    const double noise = pair.found.distance - pair.found.certified;
    // A tilt of the facets counts for a prism's height, too.
    if (are_facets_of_boxes(pair)) pair.contact.depth_error = noise;
    const bool certified =
        pair.found.distance > 0.0
            ? pair.found.certified > p.error_bound
            : pair.found.distance + pair.contact.depth_error < -p.error_bound &&
                  (is_shortest(pair, p.size) ||
                   (are_facets_of_boxes(pair) && is_shortest_of_boxes(pair, p.size)));
    const double gap = noise + pair.contact.depth_error + 2.0 * p.error_bound;
    if (!certified || !(noise <= p.gap_tolerance) ||
        !(p.converged(gap) ||
          converges_with_radii(pair.a, pair.b, p.size, pair.found.distance, gap))) {
      return false;
    }
  }
  assert(is_unit_or_unknown(vec3(pair.found.n_A)));
  pair.on_a.penetrating = pair.contact.touching || !(pair.found.distance > 0.0);
  pair.on_a.point = vec3(pair.found.a_A);
  pair.on_b.point = vec3(pair.found.b_B);
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
  while (result == Transition::kMoved && pair.made.all < kMostTransitions) {
    ++pair.made.all;
    result = penetrating_transition(pair);
  }
  if (result == Transition::kClosest && certify_penetration(pair)) return true;
  pair.on_a = before_a;
  pair.on_b = before_b;
  return false;
}

// Far below a facet's plane, as a part of the size, features seldom certify a depth.
inline constexpr double kShallow = 0x1p-5;

// Are the features where tracking ended worth a test for contact?
HWY_INLINE bool may_touch(const TrackedPair& pair, TrackingEnd end) {
  if (end == TrackingEnd::kExhausted) return false;
  return !(pair.found.distance < -kShallow * size_of(pair)) || are_facets_of_boxes(pair);
}

HWY_INLINE void write_penetration(const TrackedPair& pair, Answer& answer) {
  write(pair, answer);
  answer.path = DistancePath::kPenetration;
  const double distance = pair.found.distance;
  if (!pair.contact.touching && distance > 0.0) return;
  const double farthest = pair.contact.touching ? std::abs(distance) : distance;
  answer.upper = (farthest + pair.contact.depth_error) + pair.found.error_bound;
}

// Answers bodies that touch or penetrate each other at the features of the state or near them.
HWY_INLINE bool track_contact(const Query4& q, Answer& answer) {
  TrackedPair pair(q);
  if (!track_penetrating_features(pair) || (pair.on_a.penetrating && !q.depth)) return false;
  write_penetration(pair, answer);
  return true;
}

// Level boxes slide from one pair of features to another, and the last one may certify nothing.
inline HWY_NOINLINE bool restart_contact(const Query4& q, Answer& answer) {
  return shared_axes(squares_of(q.a_from_b.rotation)) != 0 && start_boxes(q) != Start::kNone &&
         track_contact(q, answer);
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
