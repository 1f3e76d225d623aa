#include "core/penetration/penetration.hpp"

#include <algorithm>
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
  const auto has = [](const TrackingState::Side& side, FeatureKind kind, std::size_t count) {
    return side.kind == kind && side.feature >= 0 && static_cast<std::size_t>(side.feature) < count;
  };
  if (has(state.a, FeatureKind::kFacet, a.body().facets.size())) {
    out = {a.body().facets[state.a.feature].normal, state.a.feature, kNone};
    return true;
  }
  if (has(state.b, FeatureKind::kFacet, b.body().facets.size())) {
    const Vec3& normal = b.body().facets[state.b.feature].normal;
    out = {-b.direction_to_a(normal).normalized(), kNone, state.b.feature};
    return true;
  }
  if (!has(state.a, FeatureKind::kEdge, a.body().edges.size()) ||
      !has(state.b, FeatureKind::kEdge, b.body().edges.size())) {
    return false;
  }
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

Depth tracked_depth(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                    const TrackingState& state) noexcept {
  const ActiveFeature side_a(a, nullptr), side_b(b, &a_from_b);
  Separator guess;
  if (!direction_of(side_a, side_b, state, guess)) guess = between_interiors(side_a, side_b);
  return depth(side_a, side_b, a_from_b, &guess);
}

void conclude_penetrating(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                          const Depth& found, TrackingState& state, DistanceResult& r) noexcept {
  r.status = DistanceStatus::kOverlapping;
  r.lower = -found.upper;
  r.upper = -found.lower;
  r.distance = std::clamp(-found.value, r.lower, r.upper);
  r.normal = found.normal;
  place_witnesses(a, b, a_from_b, found, state, r);
  state.a.penetrating = true;
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

bool track_penetration(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                       TrackingState& state, DistanceResult& result,
                       std::optional<Depth>& found) noexcept {
  if (!state.a.penetrating) return false;
  state.a.penetrating = false;
  found = tracked_depth(a, b, a_from_b, state);
  if (!(found->lower > 0.0)) return false;
  conclude_penetrating(a, b, a_from_b, *found, state, result);
  return true;
}

void measure_penetration(const ConvexBody& a, const ConvexBody& b, const RelativePose& a_from_b,
                         TrackingState& state, DistanceResult& result,
                         const std::optional<Depth>& known) noexcept {
  const Depth found = known ? *known : tracked_depth(a, b, a_from_b, state);
  if (found.lower > 0.0) {
    conclude_penetrating(a, b, a_from_b, found, state, result);
    return;
  }
  // The bodies are neither certainly disjoint nor certainly overlapping. Both the bounds of the
  // distance and those of the depth hold, and so do the better ones of them.
  if (-found.upper > result.lower) {
    result.lower = -found.upper;
    result.normal = found.normal;
  }
  result.upper = std::min(result.upper, -found.lower);
  result.distance = std::max(std::min(result.distance, result.upper), result.lower);
  const Precision p = precision(a, b, a_from_b, std::max(0.0, result.distance));
  // A penetration by less than the error bound can be seen from one side only: thrice.
  const bool narrow = result.upper - result.lower <= 3.0 * p.error_bound + 5.0 * p.gap_tolerance;
  if (narrow) {
    // The features that touch certify the contact of the next query by themselves. A facet beside
    // which the search has stopped may be another one than the one that separates.
    if (state.a.kind == FeatureKind::kFacet || state.b.kind == FeatureKind::kFacet) {
      separate_by(found, state);
    }
    state.a.penetrating = !a.facets.empty() || !b.facets.empty();
    result.status = result.lower > 0.0 ? DistanceStatus::kConverged : DistanceStatus::kTouching;
    return;
  }
  result.status = DistanceStatus::kIterationLimit;
  const Vec3 between = result.point_on_b - result.point_on_a;
  if (!between.isZero(0.0)) result.normal = unit_along(between);
}

}  // namespace clearance
