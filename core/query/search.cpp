#include "core/query/search.hpp"

#include <algorithm>
#include <cmath>

#include "core/active_set/active_feature.hpp"
#include "core/active_set/certificate.hpp"
#include "core/active_set/dqp3.hpp"
#include "core/curved/curved_distance.hpp"
#include "core/feature_walk/feature_walk.hpp"
#include "core/gjk/gjk.hpp"
#include "core/model/error_bounds.hpp"
#include "core/model/radii.hpp"
#include "core/penetration/penetration.hpp"

namespace clearance {
namespace {

// What is known so far of the distance between the polyhedra, the error bound not yet taken off.
struct Bounds {
  double lower = -kInfinity;
  double upper = kInfinity;
  double beyond = 0.0;  // what the points' places may cost beyond the error bound
  Vec3 normal = Vec3::Zero();

  [[nodiscard]] double certified_upper() const noexcept { return upper + beyond; }
  void raise(double value, const Vec3& n) noexcept {
    if (value > lower) {
      lower = value;
      normal = n;
    }
  }
};

// Tries the separating directions in their order, until the bounds are as near as they can be.
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
  r.point_on_a = a.common();
  r.point_on_b = b.common();
  r.status = judge(bounds, p, r);
  return r;
}

// The distance that the optimal active set certifies by itself: both bodies lie behind their
// features along n. Along an active edge the body may reach its whole length farther, as far as
// rounding tilts n.
double certified_distance(const Vec3& n, double apart, const ActiveFeature& a,
                          const ActiveFeature& b, const Precision& p) noexcept {
  const auto along_edge = [&](const ActiveFeature& s) {
    return s.feature() == FeatureKind::kEdge
               ? std::abs(s.direction_to_own(n).dot(s.edge().direction))
               : 0.0;
  };
  return apart - 2.0 * (p.reach_a * along_edge(a) + p.reach_b * along_edge(b));
}

// m: what rounding costs points that lie far beyond where Precision looks for the closest points of
// unbounded bodies, as those of lines that are nearly parallel.
double beyond_reach(const ActiveFeature& a, const ActiveFeature& b, const RelativePose& a_from_b,
                    const Precision& p) noexcept {
  if (a.body().bounded() || b.body().bounded()) return 0.0;
  const double out_a = std::max(0.0, a.own().norm() - p.reach_a);
  const double out_b = std::max(0.0, b.own().norm() - p.reach_b);
  return kUlp * (kUlpsOnA * out_a + kUlpsOnB * out_b) + a_from_b.rotation_error * out_b;
}

// Of the polyhedra, without radii: DQP3, its certificate, and GJK where that is too wide.
DistanceResult core_distance(ActiveFeature& a, ActiveFeature& b,
                             const RelativePose& a_from_b) noexcept {
  // Any two points bound the distance from above, and with it where on an unbounded body the
  // closest points can lie.
  const double first = (b.common() - a.common()).norm();
  const Precision start = precision(a.body(), b.body(), a_from_b, first);
  const Dqp3Outcome outcome = dqp3(a, b, start.gap_tolerance);

  Bounds bounds;
  bounds.upper = (b.common() - a.common()).norm();
  const Precision p = precision(a.body(), b.body(), a_from_b, std::min(first, bounds.upper));
  bounds.beyond = beyond_reach(a, b, a_from_b, p);
  if (outcome.end == Dqp3End::kCertified && (a.body().bounded() || b.body().bounded())) {
    const double apart = outcome.separating_direction.norm();
    const Vec3 n = outcome.separating_direction / apart;
    bounds.raise(certified_distance(n, apart, a, b, p), n);
  }
  const bool met = outcome.end == Dqp3End::kContact;
  if (!met && !(bounds.certified_upper() - bounds.lower <= p.gap_tolerance)) {
    certify_lower(bounds, a, b, p);
  }
  DistanceResult result = conclude(a, b, bounds, p);
  result.path = DistancePath::kActiveSet;
  const double above = met ? 0.0 : bounds.lower;  // where they met, the depth bounds it from below
  if (bounds.certified_upper() - above > p.gap_tolerance) {
    refine(a, b, a_from_b, p, result);
    result.path = DistancePath::kGjk;
  }
  // Points far away, whose places cost much, may be nearer than is certified.
  result.distance = std::max(result.distance, std::min(result.lower, result.upper));
  result.iterations = outcome.iterations;
  return result;
}

// From the features of the state on, which it moves on; of the polyhedra, without radii.
DistanceResult searched(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                        TrackingState& state, bool depth) noexcept {
  ActiveFeature side_a(a, nullptr), side_b(b, &a_from_b);
  const double apart = a_from_b.translation.norm();
  side_a.place_near(state.a, side_b, apart);
  side_b.place_near(state.b, side_a, apart);
  DistanceResult result = core_distance(side_a, side_b, a_from_b);
  // Whatever came of it: the next query starts here.
  state = {side_a.tracked(), side_b.tracked()};
  if (result.lower > 0.0) return result;
  if (depth) {
    measure_penetration(a, b, a_from_b, state, result);
  } else {
    result.status = DistanceStatus::kDepthNotAsked;
  }
  return result;
}

}  // namespace

DistanceResult by_search(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                         TrackingState& state, bool depth) noexcept {
  if (!is_good(a_from_b)) return of_bad_pose(state);
  DistanceResult result = searched(a, b, a_from_b, state, depth);
  add_radii(result, a, b);
  return result;
}

DistanceResult by_direction(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                            TrackingState& state, bool depth) noexcept {
  return curved_distance(a, b, a_from_b, state, depth);
}

DistanceResult by_direction(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                            const Pose& world_from_b, TrackingState& state) noexcept {
  return curved_distance(a, b, world_from_a, world_from_b, state);
}

DistanceResult by_depth(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                        TrackingState& state) noexcept {
  if (!is_good(a_from_b)) return of_bad_pose(state);
  DistanceResult result;
  if (track_penetration(a, b, a_from_b, state, result)) {
    result.path = DistancePath::kPenetration;
  } else if (walk_features(a, b, a_from_b, state, result) != WalkEnd::kCertified) {
    return by_search(a, b, a_from_b, state, true);
  }
  add_radii(result, a, b);
  return result;
}

}  // namespace clearance
