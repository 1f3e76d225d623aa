#include "core/penetration/witness_points.hpp"

#include <algorithm>
#include <cassert>
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

// The closest points of A and of B, starting from the features of the state.
std::uint16_t closest_points(const Query& q) noexcept {
  ActiveFeature a(q.a, nullptr), b(q.b, &q.a_from_b);
  const double between_origins = q.a_from_b.translation.norm();
  a.place_near(q.state.a, b, between_origins);
  b.place_near(q.state.b, a, between_origins);
  const std::uint16_t iterations = dqp3(a, b, 0.0).iterations;
  q.state = {a.tracked(), b.tracked()};
  return iterations;
}

// Makes the state's points the witness points. Returns by how much they miss each other: the length
// of their difference less distance * normal, m.
double take_points(const RelativePose& a_from_b, const TrackingState& state, Answer& r) noexcept {
  r.point_on_a = state.a.point;
  r.point_on_b = a_from_b.rotation * state.b.point + a_from_b.translation;
  return (r.point_on_b - r.point_on_a - r.distance * r.normal).norm();
}

// Points within this part of the size from the place to which the normal leads stay unchanged:
// rounding moves them as much.
constexpr double kPointTolerance = 0x1p-47;

// `moved`: the query with B moved, and its own state. Returns the distance of the points from each
// other across the normal, and leaves the answer unchanged unless that is less than `beside`.
double bring_together(const Query& moved, const RelativePose& a_from_b, double beside,
                      Answer& r) noexcept {
  const Answer before = r;
  r.iterations += closest_points(moved);
  const double after = take_points(a_from_b, moved.state, r);
  if (after < beside) return after;
  r = before;
  return beside;
}

// A state at the support vertices along the normal, for bodies that have vertices.
TrackingState at_support_vertices(const ConvexBody& a, const ConvexBody& b,
                                  const RelativePose& a_from_b, const Vec3& normal) noexcept {
  const std::int32_t vertex_a = support(a, normal).anchor;
  const std::int32_t vertex_b = support(b, -(a_from_b.rotation.transpose() * normal)).anchor;
  return {{FeatureKind::kVertex, false, vertex_a, a.anchors[vertex_a]},
          {FeatureKind::kVertex, false, vertex_b, b.anchors[vertex_b]}};
}

}  // namespace

void place_witnesses(const Query& q, const Depth& found, Answer& r) noexcept {
  assert(found.lower > 0.0 && is_unit_or_unknown(found.normal));
  const double size = size_of(q.a, q.b, q.a_from_b.translation.norm());
  const double farther = std::max(found.value, size > 0.0 ? kFarther * size : 1.0);
  RelativePose pose = q.a_from_b;
  const Query moved{q.a, q.b, pose, q.state};
  pose.translation += (found.value + farther) * found.normal;
  Answer separated;
  const bool closest = are_closest(track_features(moved, separated));
  r.iterations = closest ? separated.iterations : closest_points(moved);
  const double beside = take_points(q.a_from_b, q.state, r);
  if (!(beside > kBeside * size)) return;
  pose.translation = q.a_from_b.translation + (found.value + kNearer * size) * found.normal;
  const double nearer = bring_together(moved, q.a_from_b, beside, r);
  // The features may be tilted by more than rounding. At so small a distance they cannot be
  // distinguished from the right ones, and no transition leaves them.
  const double along = (r.point_on_b - r.point_on_a).dot(r.normal) - r.distance;
  if (std::abs(along) <= kPointTolerance * size || q.a.vertices.empty() || q.b.vertices.empty()) {
    return;
  }
  TrackingState support = at_support_vertices(q.a, q.b, q.a_from_b, found.normal);
  if (bring_together({q.a, q.b, pose, support}, q.a_from_b, nearer, r) < nearer) q.state = support;
}

}  // namespace clearance
