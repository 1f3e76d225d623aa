// Overlapping bodies that part soonest between the same features as in the last query. Compiled
// once a vector width: see core/numerics/vec4-inl.hpp.
//
// Features that touch when B has been moved along n bound the depth from above, as separating ones
// bound the distance from below: with the sign turned, the steps of core/feature_walk/steps-inl.hpp
// say how far that is. That no other direction is shorter is proved by what the difference body
// (core/penetration/depth.hpp) is certain to hold: a disc across n, of radius w about the foot h n
// of the origin, which is the room that the touching point has on its facet; and the difference of
// the bodies' middles, which lies d beyond the origin and l beside it. Along a direction at an
// angle f to n the disc reaches h cos f + w sin f, at least h up to tan(f/2) = w/h; the middles -d
// cos f - l sin f at least, a sinusoid that is lowest at an end of what is left. It is enough that
// it reaches h where the disc ends.
#if defined(CLEARANCE_CORE_OVERLAP_WALK) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_OVERLAP_WALK
#undef CLEARANCE_CORE_OVERLAP_WALK
#else
#define CLEARANCE_CORE_OVERLAP_WALK
#endif

#include <algorithm>
#include <cmath>

#include "core/feature_walk/steps-inl.hpp"
#include "core/model/radii.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {
// Far more than rounding does to lengths, as a part of the pair's size: what other directions are
// deeper by need not be known any better.
inline constexpr double kAmple = 1e-9;

// How far within its facet a point of its plane lies; negative: outside.
HWY_INLINE double room_on_facet(const ConvexPolyhedron& body, const Facet& facet, Quad point) {
  const double* row = body.facet_limits.row(facet.first_side);
  const std::int32_t n = facet.limits;
  const Quad at[3] = {spread(lane(point, 0)), spread(lane(point, 1)), spread(lane(point, 2))};
  double least = kInfinity;
  for (std::int32_t i = 0; i < n; i += 4) {
    const Quad within = rates(row, n, i, at) - load4(row + 3 * n + i);
    for (std::int32_t k = 0; k < 4 && i + k < n; ++k) least = std::min(least, lane(within, k));
  }
  return least;
}

// Of a pair that holds: the disc's radius.
HWY_INLINE double room_of(const Walk& w) {
  double room = w.room;
  if (w.on_a.dimension == 2) {
    room = std::max(room, room_on_facet(w.a, w.a.facets[w.on_a.feature], w.point_a));
  }
  if (w.on_b.dimension == 2) {
    room = std::max(room, room_on_facet(w.b, w.b.facets[w.on_b.feature], w.own_b));
  }
  return room;
}

// Edges that cross, each within the other body.
HWY_INLINE Step overlapping_edges(Walk& w) {
  if (!w.a.bounded() || !w.b.bounded()) return Step::kLost;
  EdgeLines lines(w);
  if (!(lines.sine2 > kCrossingSine2)) return Step::kLost;
  lines.find_nearest();
  const double s = lines.s, t = lines.t;
  const double to_end =
      std::min(std::min(s, lines.first.end - s), std::min(t, lines.second.end - t));
  const double sine = std::sqrt(lines.sine2), limit = -kCertainRate * sine,
               across = dot(lines.between, lines.n);
  const Quad g = with_signs(lines.n, spread(std::copysign(0.0, -across)));
  const Quad back = -direction_to_b(w.a_from_b, g);
  if (!(to_end > 0.0) || !sides_fall(lines.first, g, limit) ||
      !sides_fall(lines.second, back, limit)) {
    return Step::kLost;
  }
  w.normal = g / spread(sine);
  lines.place_witnesses(w);
  w.apart = -std::abs(across) / sine;
  w.room = to_end * sine;
  // As far as the normal may be tilted, the edges' own plane is nearer, too.
  const double tilt = lines.reach_of_tilt(w);
  w.proved = w.apart - tilt;
  w.beyond = tilt;
  return Step::kHolds;
}

HWY_INLINE Step overlapping_step(Walk& w) {
  w.room = w.beyond = 0.0;
  switch (w.on_a.dimension * 3 + w.on_b.dimension) {
    case 2:
      return facet_vertex(Owned<true>{w});
    case 4:
      return overlapping_edges(w);
    case 5:
      return edge_facet(Owned<false>{w});
    case 6:
      return facet_vertex(Owned<false>{w});
    case 7:
      return edge_facet(Owned<true>{w});
    case 8:
      return facet_facet(w);
    default:
      return Step::kLost;
  }
}

// Is every other way out longer?
HWY_INLINE bool is_shortest(const Walk& w, double size) {
  const Quad middles = point_to_a(w.a_from_b, load3(w.b.interior)) - load3(w.a.interior);
  const double along = dot(middles, w.normal), off = kAmple * size;
  const double height = off - w.apart, radius = room_of(w) - off, d = along - off;
  const double l = off + norm(middles - along * w.normal), k = height / radius;
  return radius > height && d * (1.0 - k * k) - 2.0 * k * l > height * (1.0 + k * k);
}

HWY_INLINE bool conclude_overlap(Walk& w) {
  const RelativeQuads& pose = w.a_from_b;
  const PlacePrecision place{pose.rotation_error, pose.translation_error, pose.apart};
  const Precision p = precision(w.a, w.b, place, std::abs(w.apart));
  w.slack = p.slack;
  const bool proved =
      w.apart > 0.0 ? w.proved > p.slack : w.apart + w.beyond < -p.slack && is_shortest(w, p.size);
  const double noise = w.apart - w.proved;
  const double gap = noise + w.beyond + 2.0 * p.slack;
  if (!proved || !(noise <= p.tight) || !is_as_promised(w.a, w.b, p.size, w.apart, gap)) {
    return false;
  }
  w.on_a.deep = !(w.apart > 0.0);
  w.on_a.point = vec3(w.point_a);
  w.on_b.point = vec3(w.own_b);
  return true;
}

// Of bodies that overlapped: is their depth proved, or that they do not any more? If not, the
// features are those that it began with.
HWY_INLINE bool walk_overlap(Walk& w) {
  if (!w.a.bounded() && !w.b.bounded()) return false;
  if (!exists(w.a, w.on_a) || !exists(w.b, w.on_b)) return false;
  const Side before_a = w.on_a, before_b = w.on_b;
  w.overlapping = true;
  Step result = Step::kMoved;
  while (result == Step::kMoved && w.steps < kSteps) {
    ++w.steps;
    result = overlapping_step(w);
  }
  if (result == Step::kHolds && conclude_overlap(w)) return true;
  w.on_a = before_a;
  w.on_b = before_b;
  return false;
}

// Of a walk that has proved something.
HWY_INLINE DistanceResult overlap_result_of(const Walk& w) {
  DistanceResult r = result_of(w);
  r.path = DistancePath::kOverlap;
  if (w.apart > 0.0) return r;
  r.upper = (w.apart + w.beyond) + w.slack;
  r.status = DistanceStatus::kOverlapping;
  return r;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
