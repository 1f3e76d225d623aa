#include "core/penetration/witness_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/active_set/dqp3.hpp"
#include "core/feature_walk/feature_walk.hpp"
#include "core/model/support_function.hpp"

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

// The closest points of A and of B as `moved`, from the features of the state on.
std::uint16_t closest_when_moved(const ConvexBody& a, const ConvexBody& b,
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
constexpr double kPointTolerance = 0x1p-47;

// From the features of the state, unless that brings the points farther beside each other than
// `beside`; how far they are then.
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

// At the support vertices along the normal, of bodies that have any.
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
  DistanceResult apart;
  if (walk_features(a, b, moved, state, apart) != WalkEnd::kUndecided) {
    r.iterations = apart.iterations;
  } else {
    r.iterations = closest_when_moved(a, b, moved, state);
  }
  const double beside = take_points(a_from_b, state, r);
  if (!(beside > kBeside * size)) return;
  moved.translation = a_from_b.translation + (found.value + kNearer * size) * found.normal;
  const double nearer = bring_together(a, b, a_from_b, moved, beside, state, r);
  // The features may be tilted by more than rounding, and yet not be told from the right ones at
  // so small a distance, nor left by steps.
  const double along = (r.point_on_b - r.point_on_a).dot(r.normal) - r.distance;
  if (std::abs(along) <= kPointTolerance * size || a.vertices.empty() || b.vertices.empty()) return;
  TrackingState support = at_support_vertices(a, b, a_from_b, found.normal);
  if (bring_together(a, b, a_from_b, moved, nearer, support, r) < nearer) state = support;
}

}  // namespace clearance
