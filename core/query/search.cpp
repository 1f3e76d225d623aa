#include "core/query/search.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "core/active_set/active_feature.hpp"
#include "core/active_set/certificate.hpp"
#include "core/active_set/dqp3.hpp"
#include "core/feature_tracking/feature_tracking.hpp"
#include "core/gjk/gjk.hpp"
#include "core/model/bad_pose.hpp"
#include "core/model/error_bounds.hpp"
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

Answer conclude(const ActiveFeature& a, const ActiveFeature& b, const Bounds& bounds,
                const Precision& p) noexcept {
  Answer r;
  r.lower = bounds.lower - p.error_bound;
  r.upper = bounds.certified_upper() + p.error_bound;
  r.distance = bounds.upper;
  r.normal = unit_along(bounds.normal);
  r.point_on_a = a.point_A();
  r.point_on_b = b.point_A();
  r.path = DistancePath::kActiveSet;
  return r;
}

// The distance that the optimal active set certifies by itself: both bodies lie behind their
// features along n. Rounding tilts n against an active edge, which may change the body's support
// value over its whole size.
double certified_distance(const Vec3& n, double distance, const ActiveFeature& a,
                          const ActiveFeature& b, const Precision& p) noexcept {
  const auto along_edge = [&](const ActiveFeature& s) {
    return s.feature() == FeatureKind::kEdge
               ? std::abs(s.direction_A_to_L(n).dot(s.edge().direction))
               : 0.0;
  };
  return distance - 2.0 * (p.extent_a * along_edge(a) + p.extent_b * along_edge(b));
}

// m: the rounding error of points of unbounded bodies that lie farther out than Precision assumes.
// Lines that are nearly parallel have such points.
double error_far_out(const ActiveFeature& a, const ActiveFeature& b, const RelativePose& a_from_b,
                     const Precision& p) noexcept {
  if (a.body().bounded() || b.body().bounded()) return 0.0;
  const double out_a = std::max(0.0, a.point_L().norm() - p.extent_a);
  const double out_b = std::max(0.0, b.point_L().norm() - p.extent_b);
  return kUlp * (kUlpsOnA * out_a + kUlpsOnB * out_b) + a_from_b.rotation_error * out_b;
}

// DQP3, its certificate, and GJK if that is too wide. The features end at the witness points.
Answer disjoint_answer(ActiveFeature& a, ActiveFeature& b, const RelativePose& a_from_b) noexcept {
  // Any two points bound the distance from above. This bound limits the part of an unbounded body
  // in which the closest points can lie.
  const double first = (b.point_A() - a.point_A()).norm();
  const Precision start = precision(a.body(), b.body(), a_from_b, first);
  const Dqp3Outcome outcome = dqp3(a, b, start.gap_tolerance);

  Bounds bounds;
  bounds.upper = (b.point_A() - a.point_A()).norm();
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
  Answer answer = conclude(a, b, bounds, p);
  const double above = met ? 0.0 : bounds.lower;  // if they meet, the depth bounds it from below
  if (bounds.certified_upper() - above > p.gap_tolerance) {
    refine(a, b, a_from_b, p, answer);
    answer.path = DistancePath::kGjk;
  }
  // Points far away have large rounding errors, and their distance may come out below the certified
  // bound.
  answer.distance = std::max(answer.distance, std::min(answer.lower, answer.upper));
  answer.iterations = outcome.iterations;
  if (p.converged(answer.upper - answer.lower)) answer.status = DistanceStatus::kConverged;
  return answer;
}

// `known`: the depth, if it is known already.
Answer active_set_answer(const Query& q, const std::optional<Depth>& known) noexcept {
  ActiveFeature a(q.a, nullptr), b(q.b, &q.a_from_b);
  const double between_origins = q.a_from_b.translation.norm();
  a.place_near(q.state.a, b, between_origins);
  b.place_near(q.state.b, a, between_origins);
  Answer answer = disjoint_answer(a, b, q.a_from_b);
  // The next query starts here, whatever the answer.
  q.state = {a.tracked(), b.tracked()};
  if (answer.lower > 0.0) return answer;
  if (q.depth) {
    measure_penetration(q, known, answer);
  } else {
    answer.status = DistanceStatus::kDepthNotAsked;
  }
  return answer;
}

}  // namespace

Answer search(const Query& q) noexcept {
  assert(is_good(q.a_from_b) && !q.a.is_curved() && !q.b.is_curved());
  Answer answer;
  std::optional<Depth> depth;
  const bool tracked =
      q.state.a.penetrating && q.depth &&
      (track_penetration(q, answer, depth) || track_features(q, answer) == TrackingEnd::kCertified);
  if (!tracked) answer = active_set_answer(q, depth);
  assert(keeps_promises(answer));
  return answer;
}

}  // namespace clearance
