#include "core/penetration/penetration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/active_set/dqp3.hpp"
#include "core/feature_walk/feature_walk.hpp"
#include "core/model/error_bounds.hpp"
#include "core/model/support_function.hpp"
#include "core/numerics/error_constants.hpp"
#include "core/penetration/depth.hpp"

namespace clearance {
namespace {

// To find the points that meet when B has been moved by its depth, B is moved a little farther: by
// the depth again, at least by this part of the bodies' size, so that the direction between the
// closest points is not lost in rounding.
constexpr double kFarther = 0x1p-20;

// At a distance f a point that lies beside the closest one by sqrt(2 f) roundings is as close as
// doubles can tell. Where edges are nearly parallel that is more than this part of the size, and B
// is moved out by no more than the other one: there it is sqrt(2^-43 2^-53) = 2^-48.
constexpr double kBeside = 0x1p-50, kNearer = 0x1p-44;

// The direction along which the features of a tracking state part the bodies. False: they do not
// say.
bool direction_of(const ActiveFeature& a, const ActiveFeature& b, const TrackingState& state,
                  Separator& out) noexcept {
  const auto has = [](const TrackingState::Side& side, FeatureKind kind, std::size_t count) {
    return side.kind == kind && side.feature >= 0 && static_cast<std::size_t>(side.feature) < count;
  };
  if (has(state.a, FeatureKind::kFacet, a.body().facets.size())) {
    out = {a.body().facets[state.a.feature].normal, state.a.feature, kNone};
    return true;
  }
  if (has(state.b, FeatureKind::kFacet, b.body().facets.size())) {
    const Vec3& normal = b.body().facets[state.b.feature].normal;
    out = {-b.direction_to_common(normal).normalized(), kNone, state.b.feature};
    return true;
  }
  if (!has(state.a, FeatureKind::kEdge, a.body().edges.size()) ||
      !has(state.b, FeatureKind::kEdge, b.body().edges.size())) {
    return false;
  }
  const Edge& e = a.body().edges[state.a.feature];
  const Vec3 n =
      e.direction.cross(b.direction_to_common(b.body().edges[state.b.feature].direction));
  const double sine2 = n.squaredNorm();
  if (!(sine2 > kCrossingSine2)) return false;
  const double inwards = (e.inward * n).sum(), sine = std::sqrt(sine2);
  out = {n / (inwards > 0.0 ? -sine : sine), kNone, kNone, state.a.feature, state.b.feature};
  return true;
}

// Where nothing is remembered: from one middle to the other.
Separator between_middles(const ActiveFeature& a, const ActiveFeature& b) noexcept {
  const Vec3 between = b.point_to_common(b.body().interior) - a.body().interior;
  return {between.isZero(0.0) ? Vec3::UnitZ() : unit_along(between)};
}

Depth tracked_depth(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                    const RelativePose& a_from_b, const TrackingState& state) noexcept {
  const ActiveFeature side_a(a, nullptr), side_b(b, &a_from_b);
  Separator guess;
  if (!direction_of(side_a, side_b, state, guess)) guess = between_middles(side_a, side_b);
  return depth(side_a, side_b, a_from_b, &guess);
}

// The closest points of A and of B as `moved`, from the features of the state on.
std::uint16_t settle_apart(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                           const RelativePose& moved, TrackingState& state) noexcept {
  ActiveFeature side_a(a, nullptr), side_b(b, &moved);
  const double apart = moved.translation.norm();
  side_a.place_near(state.a, side_b, apart);
  side_b.place_near(state.b, side_a, apart);
  const std::uint16_t iterations = dqp3(side_a, side_b, 0.0).iterations;
  state = {side_a.tracked(), side_b.tracked()};
  return iterations;
}

// Takes the state's points for the witness points; how far from the normal their difference ends.
double take_points(const RelativePose& a_from_b, const TrackingState& state,
                   DistanceResult& r) noexcept {
  r.point_on_a = state.a.point;
  r.point_on_b = a_from_b.rotation * state.b.point + a_from_b.translation;
  return (r.point_on_b - r.point_on_a - r.distance * r.normal).norm();
}

// Points that are less than this part of the size from where the normal leads stay where they are:
// rounding does as much.
constexpr double kLevelPoints = 0x1p-47;

// From the features of the state, unless that brings the points farther beside each other than
// `beside`; how far they are then.
double bring_together(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                      const RelativePose& a_from_b, const RelativePose& moved, double beside,
                      TrackingState& state, DistanceResult& r) noexcept {
  const DistanceResult before = r;
  r.iterations += settle_apart(a, b, moved, state);
  const double after = take_points(a_from_b, state, r);
  if (after < beside) return after;
  r = before;
  return beside;
}

// At the vertices that are farthest along the normal, of bodies that have any.
TrackingState at_farthest(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                          const RelativePose& a_from_b, const Vec3& normal) noexcept {
  const std::int32_t of_a = support(a, normal).anchor;
  const std::int32_t of_b = support(b, -(a_from_b.rotation.transpose() * normal)).anchor;
  return {{FeatureKind::kVertex, false, of_a, a.anchors[of_a]},
          {FeatureKind::kVertex, false, of_b, b.anchors[of_b]}};
}

// The points that meet when B has been moved clear of A.
void place_witnesses(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                     const RelativePose& a_from_b, const Depth& found, TrackingState& state,
                     DistanceResult& r) noexcept {
  const double size = a.bounding_radius + b.bounding_radius + a_from_b.translation.norm();
  const double farther = std::max(found.value, size > 0.0 ? kFarther * size : 1.0);
  RelativePose moved = a_from_b;
  moved.translation += (found.value + farther) * found.normal;
  DistanceResult apart;
  if (walk_features(a, b, moved, state, apart) != WalkEnd::kUndecided) {
    r.iterations = apart.iterations;
  } else {
    r.iterations = settle_apart(a, b, moved, state);
  }
  const double beside = take_points(a_from_b, state, r);
  if (!(beside > kBeside * size)) return;
  moved.translation = a_from_b.translation + (found.value + kNearer * size) * found.normal;
  const double nearer = bring_together(a, b, a_from_b, moved, beside, state, r);
  // Features that are level to more than rounding, and yet at so small a distance not to be told
  // from the right ones, nor left by steps.
  const double along = (r.point_on_b - r.point_on_a).dot(r.normal) - r.distance;
  if (std::abs(along) <= kLevelPoints * size || a.vertices.empty() || b.vertices.empty()) return;
  TrackingState farthest = at_farthest(a, b, a_from_b, found.normal);
  if (bring_together(a, b, a_from_b, moved, nearer, farthest, r) < nearer) state = farthest;
}

void conclude_overlapping(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                          const RelativePose& a_from_b, const Depth& found, TrackingState& state,
                          DistanceResult& r) noexcept {
  r.status = DistanceStatus::kOverlapping;
  r.lower = -found.upper;
  r.upper = -found.lower;
  if (!(found.value < kInfinity)) {
    r.distance = -kInfinity;
    r.normal = Vec3::Zero();
    return;
  }
  r.distance = std::clamp(-found.value, r.lower, r.upper);
  r.normal = found.normal;
  place_witnesses(a, b, a_from_b, found, state, r);
  state.a.penetrating = true;
}

}  // namespace

bool still_overlapping(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                       const RelativePose& a_from_b, TrackingState& state,
                       DistanceResult& result) noexcept {
  if (!state.a.penetrating) return false;
  state.a.penetrating = false;
  const Depth found = tracked_depth(a, b, a_from_b, state);
  if (!(found.lower > 0.0 && found.value < kInfinity)) return false;
  conclude_overlapping(a, b, a_from_b, found, state, result);
  return true;
}

void measure_overlap(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                     const RelativePose& a_from_b, TrackingState& state,
                     DistanceResult& result) noexcept {
  const Depth found = tracked_depth(a, b, a_from_b, state);
  if (found.lower > 0.0) {
    conclude_overlapping(a, b, a_from_b, found, state, result);
    return;
  }
  if (-found.upper > result.lower) {
    result.lower = -found.upper;
    result.normal = found.normal;
  }
  result.upper = std::min(result.upper, -found.lower);
  result.distance = std::max(std::min(result.distance, result.upper), result.lower);
  const Precision p = precision(a, b, a_from_b, std::max(0.0, result.distance));
  // An overlap by less than the slack can be seen from one side only: thrice.
  const bool tight = result.upper - result.lower <= 3.0 * p.slack + 5.0 * p.tight;
  if (tight) {
    result.status = result.lower > 0.0 ? DistanceStatus::kConverged : DistanceStatus::kTouching;
    return;
  }
  result.status = DistanceStatus::kIterationLimit;
  const Vec3 between = result.point_on_b - result.point_on_a;
  if (!between.isZero(0.0)) result.normal = unit_along(between);
}

}  // namespace clearance
