#include "core/distance.hpp"

#include <algorithm>
#include <cmath>

#include "core/active_side.hpp"
#include "core/certificate.hpp"
#include "core/dqp3.hpp"
#include "core/feature_walk.hpp"
#include "core/overlap.hpp"
#include "core/precision.hpp"
#include "core/robust.hpp"
#include "core/rounding.hpp"

namespace clearance {
namespace {

// What is known so far of the distance between the cores, slack not yet taken.
struct Bounds {
  double lower = -kInfinity;
  double upper = kInfinity;
  Vec3 normal = Vec3::Constant(std::nan(""));

  void raise(double value, const Vec3& n) noexcept {
    if (value > lower) {
      lower = value;
      normal = n;
    }
  }
};

void prove_from_below(Bounds& bounds, const ActiveSide& a, const ActiveSide& b,
                      const Precision& p) noexcept {
  for (const Separator& s : separators(a, b)) {
    bounds.raise(separation(s, a, b, p), s.normal);
    if (bounds.upper - bounds.lower <= p.tight) return;
  }
}

double radii(const ConvexPolyhedron& a, const ConvexPolyhedron& b) noexcept {
  return a.radius + b.radius;
}

// Witness points move from the cores' surfaces to the rounded bodies'.
void add_radii(DistanceResult& r, const ConvexPolyhedron& a, const ConvexPolyhedron& b) noexcept {
  const double sum = radii(a, b);
  if (sum == 0.0) return;
  const double rounding = kRadiusRounding * (sum + std::abs(r.upper - sum));
  r.distance -= sum;
  r.lower -= sum + rounding;
  r.upper -= sum - rounding;
  if (std::isfinite(r.normal.x())) {
    r.point_on_a += a.radius * r.normal;
    r.point_on_b -= b.radius * r.normal;
  }
  if (r.upper < 0.0) {
    r.status = DistanceStatus::kOverlapping;
  } else if (r.lower <= 0.0 && r.status == DistanceStatus::kConverged) {
    r.status = DistanceStatus::kTouching;
  }
}

DistanceStatus judge(const Bounds& bounds, const Precision& p, double lower) noexcept {
  if (bounds.upper - bounds.lower > 2.0 * p.tight && bounds.upper > p.slack) {
    return DistanceStatus::kIterationLimit;
  }
  return lower > 0.0 ? DistanceStatus::kConverged : DistanceStatus::kTouching;
}

DistanceResult conclude(const ActiveSide& a, const ActiveSide& b, const Bounds& bounds,
                        const Precision& p) noexcept {
  DistanceResult r;
  r.lower = bounds.lower - p.slack;
  r.upper = bounds.upper + p.slack;
  r.distance = bounds.upper;
  r.normal = bounds.normal;
  r.point_on_a = a.common();
  r.point_on_b = b.common();
  r.status = judge(bounds, p, r.lower);
  return r;
}

void place(ActiveSide& side, const TrackingState::Side& hint, const ActiveSide& other) noexcept {
  if (!side.place_tracked(hint)) {
    side.place_cold(other.point_to_common(other.body().interior));
  }
}

// The distance that the optimal active set proves by itself: what lies behind both features along
// `n`. Along an active edge the body may reach its whole length farther, as far as rounding tilts
// n.
double proved_distance(const Vec3& n, double apart, const ActiveSide& a, const ActiveSide& b,
                       const Precision& p) noexcept {
  const auto along_edge = [&](const ActiveSide& s) {
    return s.feature() == Feature::kEdge ? std::abs(s.direction_to_own(n).dot(s.edge().direction))
                                         : 0.0;
  };
  return apart - 2.0 * (p.reach_a * along_edge(a) + p.reach_b * along_edge(b));
}

DistanceResult core_distance(ActiveSide& a, ActiveSide& b, const RelativePose& a_from_b) noexcept {
  const double first = (b.common() - a.common()).norm();
  const Precision start = precision(a.body(), b.body(), a_from_b, first);
  const Dqp3Outcome outcome = dqp3(a, b, start.tight);

  Bounds bounds;
  bounds.upper = (b.common() - a.common()).norm();
  const Precision p = precision(a.body(), b.body(), a_from_b, std::min(first, bounds.upper));
  if (outcome.end == Dqp3End::kProved && (a.body().bounded() || b.body().bounded())) {
    const double apart = outcome.towards.norm();
    const Vec3 n = outcome.towards / apart;
    bounds.raise(proved_distance(n, apart, a, b, p), n);
  }
  const bool met = outcome.end == Dqp3End::kContact;
  if (!met && !(bounds.upper - bounds.lower <= p.tight)) prove_from_below(bounds, a, b, p);
  DistanceResult result = conclude(a, b, bounds, p);
  const double above = met ? 0.0 : bounds.lower;  // where they met, the depth bounds it from below
  if (bounds.upper - above > p.tight) refine(a, b, a_from_b, p, result);
  result.iterations = outcome.iterations;
  return result;
}

// From the last features to their neighbours, where that settles it.
bool by_walking(const ConvexPolyhedron& a, const ConvexPolyhedron& b, const RelativePose& a_from_b,
                TrackingState& state, DistanceResult& r) noexcept {
  ClosestFeatures closest;
  if (!walk_features(a, b, a_from_b, state, closest)) return false;
  const Precision p = precision(a, b, a_from_b, closest.apart);
  if (!(closest.proved > p.slack) || closest.apart - closest.proved > p.tight) return false;
  r.distance = closest.apart;
  r.lower = closest.proved - p.slack;
  r.upper = closest.apart + p.slack;
  r.normal = closest.normal;
  r.point_on_a = closest.point_a;
  r.point_on_b = closest.point_b;
  r.status = DistanceStatus::kConverged;
  r.iterations = static_cast<std::uint16_t>(closest.steps);
  state.a.point = closest.point_a;
  state.b.point = closest.own_b;
  return true;
}

// The spheres around the frames' origins already say that they are far apart.
bool far_by_spheres(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                    const RelativePose& a_from_b, double far_away, DistanceResult& r) noexcept {
  if (!(far_away < kInfinity) || !a.bounded() || !b.bounded()) return false;
  const double apart = a_from_b.translation.norm();
  const double size = a.bounding_radius + a.radius + b.bounding_radius + b.radius;
  const double slack = a_from_b.translation_error + 0x1p-50 * (apart + size);
  if (!(apart - size - slack >= far_away)) return false;
  r.lower = apart - size - slack;
  r.upper = apart + size + slack;
  r.distance = r.lower;
  r.normal = a_from_b.translation / apart;
  r.point_on_a = a.interior;
  r.point_on_b = a_from_b.rotation * b.interior + a_from_b.translation;
  r.status = DistanceStatus::kFarAway;
  return true;
}

}  // namespace

const char* name(DistanceStatus status) noexcept {
  switch (status) {
    case DistanceStatus::kConverged:
      return "converged";
    case DistanceStatus::kFarAway:
      return "far_away";
    case DistanceStatus::kTouching:
      return "touching";
    case DistanceStatus::kOverlapping:
      return "overlapping";
    case DistanceStatus::kIterationLimit:
      return "iteration_limit";
  }
  return "";
}

DistanceResult distance(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                        const RelativePose& a_from_b, TrackingState& state,
                        const DistanceOptions& options) noexcept {
  DistanceResult result;
  if (far_by_spheres(a, b, a_from_b, options.far_away, result)) return result;
  if (!still_overlapping(a, b, a_from_b, state, result) &&
      !by_walking(a, b, a_from_b, state, result)) {
    ActiveSide side_a(a, nullptr), side_b(b, &a_from_b);
    place(side_a, state.a, side_b);
    place(side_b, state.b, side_a);
    result = core_distance(side_a, side_b, a_from_b);
    state = {side_a.tracked(), side_b.tracked()};
    if (!(result.lower > 0.0)) measure_overlap(a, b, a_from_b, state, result);
  }
  add_radii(result, a, b);
  return result;
}

}  // namespace clearance
