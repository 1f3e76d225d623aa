#include "core/query/search.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "core/active_set/active_feature.hpp"
#include "core/active_set/certificate.hpp"
#include "core/active_set/dqp3.hpp"
#include "core/curved/curved_distance.hpp"
#include "core/feature_tracking/feature_tracking.hpp"
#include "core/gjk/gjk.hpp"
#include "core/model/error_bounds.hpp"
#include "core/model/radii.hpp"
#include "core/model/result_invariants.hpp"
#include "core/penetration/penetration.hpp"

namespace clearance {
namespace {

// The bounds of the polyhedra's distance that are known so far, without the error bound.
struct Bounds {
  double lower = -kInfinity;
  double upper = kInfinity;
  double points_error = 0.0;  // m: the error of the points' places in excess of the error bound
  Vec3 normal = Vec3::Zero();

  [[nodiscard]] double certified_upper() const noexcept { return upper + points_error; }
  void raise(double value, const Vec3& n) noexcept {
    if (value > lower) {
      lower = value;
      normal = n;
    }
  }
};

// Tries the separating directions in order, until the bounds are as near to each other as rounding
// allows.
void certify_lower(Bounds& bounds, const ActiveFeature& a, const ActiveFeature& b,
                   const Precision& p) noexcept {
  for (const Separator& s : separators(a, b)) {
    bounds.raise(separation(s, a, b, p), s.normal);
    if (bounds.certified_upper() - bounds.lower <= p.gap_tolerance) return;
  }
}

DistanceStatus judge(const Bounds& bounds, const Precision& p, const DistanceResult& r) noexcept {
  if (!p.converged(r.upper - r.lower) && bounds.upper > p.error_bound) {
    return DistanceStatus::kIterationLimit;
  }
  return r.lower > 0.0 ? DistanceStatus::kConverged : DistanceStatus::kTouching;
}

DistanceResult conclude(const ActiveFeature& a, const ActiveFeature& b, const Bounds& bounds,
                        const Precision& p) noexcept {
  DistanceResult r;
  r.lower = bounds.lower - p.error_bound;
  r.upper = bounds.certified_upper() + p.error_bound;
  r.distance = bounds.upper;
  r.normal = unit_along(bounds.normal);
  r.point_on_a = a.point_in_a();
  r.point_on_b = b.point_in_a();
  r.status = judge(bounds, p, r);
  return r;
}

// The distance that the optimal active set certifies by itself: both bodies lie behind their
// features along n. Rounding tilts n against an active edge, which may change the body's support
// value over its whole size.
double certified_distance(const Vec3& n, double distance, const ActiveFeature& a,
                          const ActiveFeature& b, const Precision& p) noexcept {
  const auto along_edge = [&](const ActiveFeature& s) {
    return s.feature() == FeatureKind::kEdge
               ? std::abs(s.direction_to_local(n).dot(s.edge().direction))
               : 0.0;
  };
  return distance - 2.0 * (p.extent_a * along_edge(a) + p.extent_b * along_edge(b));
}

// m: the rounding error of points of unbounded bodies that lie farther out than Precision assumes.
// Lines that are nearly parallel have such points.
double error_far_out(const ActiveFeature& a, const ActiveFeature& b, const RelativePose& a_from_b,
                     const Precision& p) noexcept {
  if (a.body().bounded() || b.body().bounded()) return 0.0;
  const double out_a = std::max(0.0, a.local_point().norm() - p.extent_a);
  const double out_b = std::max(0.0, b.local_point().norm() - p.extent_b);
  return kUlp * (kUlpsOnA * out_a + kUlpsOnB * out_b) + a_from_b.rotation_error * out_b;
}

// The distance of the polyhedra, without radii: DQP3, its certificate, and GJK if that is too wide.
DistanceResult core_distance(ActiveFeature& a, ActiveFeature& b,
                             const RelativePose& a_from_b) noexcept {
  // Any two points bound the distance from above. This bound limits the part of an unbounded body
  // in which the closest points can lie.
  const double first = (b.point_in_a() - a.point_in_a()).norm();
  const Precision start = precision(a.body(), b.body(), a_from_b, first);
  const Dqp3Outcome outcome = dqp3(a, b, start.gap_tolerance);

  Bounds bounds;
  bounds.upper = (b.point_in_a() - a.point_in_a()).norm();
  const Precision p = precision(a.body(), b.body(), a_from_b, std::min(first, bounds.upper));
  bounds.points_error = error_far_out(a, b, a_from_b, p);
  if (outcome.end == Dqp3End::kCertified && (a.body().bounded() || b.body().bounded())) {
    const double distance = outcome.separating_direction.norm();
    const Vec3 n = outcome.separating_direction / distance;
    bounds.raise(certified_distance(n, distance, a, b, p), n);
  }
  const bool met = outcome.end == Dqp3End::kContact;
  if (!met && !(bounds.certified_upper() - bounds.lower <= p.gap_tolerance)) {
    certify_lower(bounds, a, b, p);
  }
  DistanceResult result = conclude(a, b, bounds, p);
  result.path = DistancePath::kActiveSet;
  const double above = met ? 0.0 : bounds.lower;  // if they meet, the depth bounds it from below
  if (bounds.certified_upper() - above > p.gap_tolerance) {
    refine(a, b, a_from_b, p, result);
    result.path = DistancePath::kGjk;
  }
  // Points far away have large rounding errors, and their distance may come out below the certified
  // bound.
  result.distance = std::max(result.distance, std::min(result.lower, result.upper));
  result.iterations = outcome.iterations;
  return result;
}

// Starts from the features of the state, and writes the new ones to it. For the polyhedra, without
// radii.
DistanceResult searched(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                        TrackingState& state, bool depth,
                        const std::optional<Depth>& known) noexcept {
  ActiveFeature side_a(a, nullptr), side_b(b, &a_from_b);
  const double between_origins = a_from_b.translation.norm();
  side_a.place_near(state.a, side_b, between_origins);
  side_b.place_near(state.b, side_a, between_origins);
  DistanceResult result = core_distance(side_a, side_b, a_from_b);
  // The next query starts here, whatever the result.
  state = {side_a.tracked(), side_b.tracked()};
  if (result.lower > 0.0) return result;
  if (depth) {
    measure_penetration(a, b, a_from_b, state, result, known);
  } else {
    result.status = DistanceStatus::kDepthNotAsked;
  }
  return result;
}

DistanceResult with_radii(DistanceResult result, const ConvexBody& a,
                          const ConvexBody& b) noexcept {
  add_radii(result, a, b);
  assert(keeps_promises(result));
  return result;
}

}  // namespace

DistanceResult search_distance(const ConvexBody& a, const ConvexBody& b,
                               const RelativePose& a_from_b, TrackingState& state,
                               bool depth) noexcept {
  if (!is_good(a_from_b)) return of_bad_pose(state);
  return with_radii(searched(a, b, a_from_b, state, depth, {}), a, b);
}

DistanceResult curved_pair_distance(const ConvexBody& a, const ConvexBody& b,
                                    const RelativePose& a_from_b, TrackingState& state,
                                    bool depth) noexcept {
  return curved_distance(a, b, a_from_b, state, depth);
}

DistanceResult curved_pair_distance(const ConvexBody& a, const ConvexBody& b,
                                    const Pose& world_from_a, const Pose& world_from_b,
                                    TrackingState& state) noexcept {
  return curved_distance(a, b, world_from_a, world_from_b, state);
}

DistanceResult penetrating_distance(const ConvexBody& a, const ConvexBody& b,
                                    const RelativePose& a_from_b, TrackingState& state) noexcept {
  if (!is_good(a_from_b)) return of_bad_pose(state);
  DistanceResult result;
  std::optional<Depth> depth;
  if (track_penetration(a, b, a_from_b, state, result, depth)) {
    result.path = DistancePath::kPenetration;
  } else if (track_features(a, b, a_from_b, state, result) != TrackingEnd::kCertified) {
    result = searched(a, b, a_from_b, state, true, depth);
  }
  return with_radii(result, a, b);
}

}  // namespace clearance
