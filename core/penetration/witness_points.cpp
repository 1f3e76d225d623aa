#include "core/penetration/witness_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/active_set/dqp3.hpp"
#include "core/feature_tracking/feature_tracking.hpp"
#include "core/model/support_function.hpp"

namespace clearance {
namespace {

// The points that meet after B has been moved by the depth are found with B moved a little farther.
// B moves by the depth again, and at least by this part of the bodies' size. Otherwise the
// direction between the closest points would be lost in rounding.
constexpr double kFarther = 0x1p-20;

// At a distance f doubles cannot tell the closest point from one that is sqrt(2 f) roundings beside
// it. For nearly parallel edges that is more than kBeside of the size. Then B is moved out by no
// more than kNearer, where it is sqrt(2^-43 2^-53) = 2^-48.
constexpr double kBeside = 0x1p-50, kNearer = 0x1p-44;

// The closest points of A and of B at the pose `moved`, starting from the features of the state.
std::uint16_t closest_when_moved(const ConvexBody& a, const ConvexBody& b,
                                 const RelativePose& moved, TrackingState& state) noexcept {
  ActiveFeature side_a(a, nullptr), side_b(b, &moved);
  const double between_origins = moved.translation.norm();
  side_a.place_near(state.a, side_b, between_origins);
  side_b.place_near(state.b, side_a, between_origins);
  const std::uint16_t iterations = dqp3(side_a, side_b, 0.0).iterations;
  state = {side_a.tracked(), side_b.tracked()};
  return iterations;
}

// Makes the state's points the witness points. Returns by how much they miss each other: the length
// of their difference less distance * normal, m.
double take_points(const RelativePose& a_from_b, const TrackingState& state,
                   DistanceResult& r) noexcept {
  r.point_on_a = state.a.point;
  r.point_on_b = a_from_b.rotation * state.b.point + a_from_b.translation;
  return (r.point_on_b - r.point_on_a - r.distance * r.normal).norm();
}

// Points within this part of the size from the place to which the normal leads stay unchanged:
// rounding moves them as much.
constexpr double kPointTolerance = 0x1p-47;

// Starts from the features of the state. Returns the distance of the points from each other across
// the normal, and leaves the result unchanged unless that is less than `beside`.
double bring_together(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                      const RelativePose& moved, double beside, TrackingState& state,
                      DistanceResult& r) noexcept {
  const DistanceResult before = r;
  r.iterations += closest_when_moved(a, b, moved, state);
  const double after = take_points(a_from_b, state, r);
  if (after < beside) return after;
  r = before;
  return beside;
}

// A state at the support vertices along the normal, for bodies that have vertices.
TrackingState at_support_vertices(const ConvexBody& a, const ConvexBody& b,
                                  const RelativePose& a_from_b, const Vec3& normal) noexcept {
  const std::int32_t of_a = support(a, normal).anchor;
  const std::int32_t of_b = support(b, -(a_from_b.rotation.transpose() * normal)).anchor;
  return {{FeatureKind::kVertex, false, of_a, a.anchors[of_a]},
          {FeatureKind::kVertex, false, of_b, b.anchors[of_b]}};
}

}  // namespace

void place_witnesses(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                     const Depth& found, TrackingState& state, DistanceResult& r) noexcept {
  const double size = a.bounding_radius + b.bounding_radius + a_from_b.translation.norm();
  const double farther = std::max(found.value, size > 0.0 ? kFarther * size : 1.0);
  RelativePose moved = a_from_b;
  moved.translation += (found.value + farther) * found.normal;
  DistanceResult separated;
  if (are_closest(track_features(a, b, moved, state, separated))) {
    r.iterations = separated.iterations;
  } else {
    r.iterations = closest_when_moved(a, b, moved, state);
  }
  const double beside = take_points(a_from_b, state, r);
  if (!(beside > kBeside * size)) return;
  moved.translation = a_from_b.translation + (found.value + kNearer * size) * found.normal;
  const double nearer = bring_together(a, b, a_from_b, moved, beside, state, r);
  // The features may be tilted by more than rounding. At so small a distance they cannot be
  // distinguished from the right ones, and no transition leaves them.
  const double along = (r.point_on_b - r.point_on_a).dot(r.normal) - r.distance;
  if (std::abs(along) <= kPointTolerance * size || a.vertices.empty() || b.vertices.empty()) return;
  TrackingState support = at_support_vertices(a, b, a_from_b, found.normal);
  if (bring_together(a, b, a_from_b, moved, nearer, support, r) < nearer) state = support;
}

}  // namespace clearance
