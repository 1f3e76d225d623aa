#include "core/curved/curved_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/curved/conclusion.hpp"
#include "core/curved/depth.hpp"
#include "core/curved/half_space.hpp"
#include "core/curved/start.hpp"
#include "core/numerics/error_constants.hpp"

namespace clearance {
namespace {

bool is_usable(const CurvedTrackingState& state, const CurvedBody& a,
               const CurvedBody& b) noexcept {
  const double square = state.normal.squaredNorm();
  if (!(std::abs(square - 1.0) < 1e-9) || state.active.count > 3) return false;
  const auto pieces = [](const CurvedBody& body) {
    if (body.kind == CurvedBody::Kind::kPolyhedron) {
      return static_cast<std::int32_t>(body.polyhedron->anchors.size());
    }
    return body.kind == CurvedBody::Kind::kEllipsoid ? 1 : 2;
  };
  for (std::size_t i = 0; i < state.active.count; ++i) {
    const PiecePair& pair = state.active.pieces[i];
    if (pair.a < 0 || pair.b < 0 || pair.a >= pieces(a) || pair.b >= pieces(b)) return false;
  }
  return true;
}

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

DistanceResult of_unknown(DistanceStatus status) noexcept {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  DistanceResult r;
  r.distance = kNaN;
  r.lower = -kInfinity;
  r.upper = kInfinity;
  r.normal = r.point_on_a = r.point_on_b = Vec3::Constant(kNaN);
  r.status = status;
  return r;
}

bool is_good(const RelativePose& pose) noexcept {
  return pose.rotation.allFinite() && pose.translation.norm() <= kLargestCoordinate;
}

bool is_bounded(const CurvedBody& body) noexcept {
  return body.kind != CurvedBody::Kind::kPolyhedron || body.polyhedron->bounded();
}

}  // namespace

DistanceResult curved_distance(const CurvedBody& a, const CurvedBody& b,
                               const RelativePose& a_from_b, CurvedTrackingState& state) noexcept {
  if (!is_good(a_from_b)) return of_unknown(DistanceStatus::kBadPose);
  if (!is_bounded(a) || !is_bounded(b)) {
    if (!is_half_space(is_bounded(a) ? b : a) || (!is_bounded(a) && !is_bounded(b))) {
      return of_unknown(DistanceStatus::kIterationLimit);
    }
    return distance_of_half_space(a, b, a_from_b, state);
  }
  CurvedPair pair(a, b, a_from_b);
  if (!is_usable(state, a, b)) state = {};
  int supports = 0;
  if (!state.normal.isZero()) {
    supports += search_direction(pair, state.normal, state.active).supports;
  }
  if (!pair.is_tight()) {
    state.active = {};
    const CurvedStart start = start_direction(pair);
    if (!start.meet) supports += search_direction(pair, start.normal, state.active).supports;
  }
  double depth = -kInfinity;
  if (!pair.is_tight() && pair.bounds.lower < 0.0) {
    const DepthBounds found = bound_depth(pair);
    depth = found.lower;
    supports += found.supports;
  }
  state.normal = pair.bounds.normal;
  keep_points(pair, depth, state);
  DistanceResult r = conclude(conclusion_of(pair, depth));
  r.iterations = static_cast<std::uint16_t>(supports);
  return r;
}

}  // namespace clearance
