#include "core/curved/curved_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/curved/conclusion.hpp"
#include "core/curved/depth.hpp"
#include "core/curved/direction_search.hpp"
#include "core/curved/half_space.hpp"
#include "core/curved/newton.hpp"
#include "core/curved/start.hpp"
#include "core/numerics/error_constants.hpp"

namespace clearance {
namespace {

// `depth`: the bodies without radii overlap by at least this, where that is known; m.
CurvedConclusion conclusion_of(const CurvedPair& pair, double depth) noexcept {
  const CurvedBounds& bounds = pair.bounds;
  CurvedConclusion found;
  found.lower = bounds.lower;
  found.upper = std::min(bounds.upper, -depth);
  found.error = pair.error();
  found.size = pair.size;
  found.radius_a = pair.a.body->radius;
  found.radius_b = pair.b.body->radius;
  found.normal = bounds.normal;
  const PointPair& points = depth > 0.0 ? bounds.deepest : bounds.points;
  found.point_on_a = points.a;
  found.point_on_b = points.b;
  return found;
}

// A point of both: of bodies that overlap by little, and of which no common point has been found,
// halfway between the deepest ones.
void keep_points(const CurvedPair& pair, double depth, CurvedTrackingState& state) noexcept {
  const CurvedBounds& bounds = pair.bounds;
  const bool common = !(depth > 0.0) || bounds.upper <= pair.gap_tolerance() ||
                      bounds.deepest.difference().norm() > 2.0 * bounds.upper;
  const PointPair& points = common ? bounds.points : bounds.deepest;
  state.own_point_on_b = (depth > 0.0 ? bounds.deepest : bounds.points).own_b;
  state.shared = common ? between(points.a, points.b, pair.a.body->radius, pair.b.body->radius)
                        : Vec3(0.5 * (points.a + points.b));
}

DistanceResult searched(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                        CurvedTrackingState& state, bool depth) noexcept {
  CurvedPair pair(a, b, a_from_b);
  // The search has no flats.
  const PiecePair& first = state.active.pieces[0];
  if (first.a >= pieces_of(a) || first.b >= pieces_of(b)) state.active.count = 0;
  int supports = 0;
  if (!state.normal.isZero()) {
    supports += search_direction(pair, state.normal.normalized(), state.active).supports;
  }
  if (!pair.is_tight()) {
    CurvedStart start = start_direction(pair);
    state.active = start.pieces;
    if (!start.meet) {
      supports += search_direction(pair, start.normal, state.active).supports;
    }
  }
  double deep = -kInfinity;
  const bool meet = !pair.is_tight() && pair.bounds.lower < 0.0;
  if (meet && depth) {
    const DepthBounds found = bound_depth(pair);
    deep = found.lower;
    supports += found.supports;
  }
  state.normal = pair.bounds.normal;
  keep_points(pair, deep, state);
  DistanceResult r = conclude(conclusion_of(pair, deep));
  r.iterations = static_cast<std::uint16_t>(supports);
  return r;
}

DistanceResult thorough(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                        CurvedTrackingState& state, bool depth) noexcept {
  DistanceResult r = a.is_half_space() || b.is_half_space()
                         ? distance_of_half_space(a, b, a_from_b, state)
                         : searched(a, b, a_from_b, state, depth);
  if (!depth && !(r.lower > 0.0)) r.status = DistanceStatus::kDepthNotAsked;
  return r;
}

}  // namespace

DistanceResult curved_distance(const ConvexBody& a, const ConvexBody& b,
                               const RelativePose& a_from_b, CurvedTrackingState& state,
                               bool depth) noexcept {
  forget_nonsense(state, a, b);
  DistanceResult r;
  if (!newton_distance(a, b, a_from_b, state, r)) return thorough(a, b, a_from_b, state, depth);
  if (!depth && !(r.lower > 0.0)) r.status = DistanceStatus::kDepthNotAsked;
  return r;
}

DistanceResult curved_distance(const ConvexBody& a, const ConvexBody& b,
                               const RelativePose& a_from_b, TrackingState& state,
                               bool depth) noexcept {
  CurvedTrackingState tracked = read(state, a, b);
  const DistanceResult r = curved_distance(a, b, a_from_b, tracked, depth);
  write(tracked, a, b, state);
  return r;
}

DistanceResult open_distance(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                             TrackingState& state) noexcept {
  CurvedTrackingState tracked = read(state, a, b);
  const DistanceResult r = thorough(a, b, a_from_b, tracked, true);
  write(tracked, a, b, state);
  return r;
}

}  // namespace clearance
