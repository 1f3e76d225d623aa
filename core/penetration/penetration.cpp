#include "core/penetration/penetration.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/model/error_bounds.hpp"
#include "core/numerics/error_constants.hpp"
#include "core/penetration/depth.hpp"
#include "core/penetration/witness_points.hpp"

namespace clearance {
namespace {

// The direction along which the features of a tracking state separate the bodies. False: the
// features determine none.
bool direction_of(const ActiveFeature& a, const ActiveFeature& b, const TrackingState& state,
                  Separator& out) noexcept {
  const auto has = [](const ActiveFeature& of, const TrackingState::Side& side, FeatureKind kind) {
    return side.kind == kind && exists(of.body(), side);
  };
  if (has(a, state.a, FeatureKind::kFacet)) {
    out = {a.body().facets[state.a.feature].normal, state.a.feature, kNone};
    return true;
  }
  if (has(b, state.b, FeatureKind::kFacet)) {
    const Vec3& normal = b.body().facets[state.b.feature].normal;
    out = {-b.direction_to_a(normal).normalized(), kNone, state.b.feature};
    return true;
  }
  if (!has(a, state.a, FeatureKind::kEdge) || !has(b, state.b, FeatureKind::kEdge)) return false;
  const Edge& e = a.body().edges[state.a.feature];
  const Vec3 n = e.direction.cross(b.direction_to_a(b.body().edges[state.b.feature].direction));
  const double sine2 = n.squaredNorm();
  if (!(sine2 > kCrossingSine2)) return false;
  // The sign that leads out of A: the facets beside the edge lie on the inner side.
  const double inwards = (e.inward * n).sum(), sine = std::sqrt(sine2);
  out = {n / (inwards > 0.0 ? -sine : sine), kNone, kNone, state.a.feature, state.b.feature};
  return true;
}

// The direction of a pair without a state: from one interior point to the other.
Separator between_interiors(const ActiveFeature& a, const ActiveFeature& b) noexcept {
  const Vec3 between = b.point_to_a(b.body().interior) - a.body().interior;
  return {between.isZero(0.0) ? Vec3::UnitZ() : unit_along(between)};
}

Depth tracked_depth(const Query& q) noexcept {
  const ActiveFeature a(q.a, nullptr), b(q.b, &q.a_from_b);
  Separator guess;
  if (!direction_of(a, b, q.state, guess)) guess = between_interiors(a, b);
  return depth(a, b, q.a_from_b, guess);
}

void conclude_penetrating(const Query& q, const Depth& found, Answer& r) noexcept {
  r.status = DistanceStatus::kConverged;
  r.lower = -found.upper;
  r.upper = -found.lower;
  r.distance = std::clamp(-found.value, r.lower, r.upper);
  r.normal = found.normal;
  place_witnesses(q, found, r);
  q.state.a.penetrating = true;
}

// Makes the facet that separates bodies which touch one of their features.
void separate_by(const Depth& found, TrackingState& state) noexcept {
  TrackingState::Side& side = found.facet_of_a != kNone ? state.a : state.b;
  const std::int32_t facet = found.facet_of_a != kNone ? found.facet_of_a : found.facet_of_b;
  if (facet == kNone) return;
  side.kind = FeatureKind::kFacet;
  side.feature = facet;
}

}  // namespace

bool track_penetration(const Query& q, Answer& answer, std::optional<Depth>& found) noexcept {
  q.state.a.penetrating = false;
  found = tracked_depth(q);
  if (!(found->lower > 0.0)) return false;
  conclude_penetrating(q, *found, answer);
  answer.path = DistancePath::kPenetration;
  return true;
}

void measure_penetration(const Query& q, const std::optional<Depth>& known, Answer& r) noexcept {
  assert(!(r.lower > 0.0));
  const Depth found = known ? *known : tracked_depth(q);
  if (found.lower > 0.0) return conclude_penetrating(q, found, r);
  // The bodies are neither certainly disjoint nor certainly overlapping. Both the bounds of the
  // distance and those of the depth prefer, and so do the better ones of them.
  if (-found.upper > r.lower) {
    r.lower = -found.upper;
    r.normal = found.normal;
  }
  r.upper = std::min(r.upper, -found.lower);
  r.distance = std::max(std::min(r.distance, r.upper), r.lower);
  const Precision p = precision(q.a, q.b, q.a_from_b, std::max(0.0, r.distance));
  if (p.is_contact(r.upper - r.lower)) {
    // The features that touch certify the contact of the next query by themselves. A facet beside
    // which the search has stopped may be another one than the one that separates.
    if (q.state.a.kind == FeatureKind::kFacet || q.state.b.kind == FeatureKind::kFacet) {
      separate_by(found, q.state);
    }
    q.state.a.penetrating = !q.a.facets.empty() || !q.b.facets.empty();
    r.status = DistanceStatus::kConverged;
    return;
  }
  r.status = DistanceStatus::kIterationLimit;
  const Vec3 between = r.point_on_b - r.point_on_a;
  if (!between.isZero(0.0)) r.normal = unit_along(between);
}

}  // namespace clearance
