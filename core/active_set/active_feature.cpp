#include "core/active_set/active_feature.hpp"

namespace clearance {
namespace {

// A stored point counts as on its facet if it lies no farther outside than this, relative to the
// body: 16 roundings, 2^-49.
constexpr double kOnFacet = 0x1p-49;

// A state may contain any numbers: the length of the point has to be finite as well.
bool is_a_point(const Vec3& v) noexcept { return v.squaredNorm() < kInfinity; }

}  // namespace

std::int32_t crossed_limit(const ConvexBody& body, const Facet& facet, const Vec3& p,
                           double tolerance) noexcept {
  double least = -tolerance;
  std::int32_t crossed = kNone;
  for (std::int32_t i = 0; i < facet.limits; ++i) {
    const FacetLimit limit = body.limit_of(facet, i);
    const double gap = limit.inward.dot(p) - limit.offset;
    if (!(gap < least)) continue;
    least = gap;
    crossed = i;
  }
  return crossed;
}

std::int32_t facet_under(const ConvexBody& body, std::int32_t index, const Vec3& p) noexcept {
  for (std::size_t hops = 0; hops < body.facets.size(); ++hops) {
    const Facet& facet = body.facets[index];
    const std::int32_t crossed = crossed_limit(body, facet, p);
    if (crossed == kNone) break;
    index = body.facets_beside[facet.first_side + crossed];
  }
  return index;
}

void ActiveFeature::place_cold(const Vec3& other) noexcept {
  if (body_.vertices.empty()) return place_inside(body_.interior);
  const Vec3 to_other = direction_A_to_L(other - point_to_a(body_.interior));
  place_at_vertex(body_.start.at(to_other));
}

bool ActiveFeature::place_tracked(const TrackingState::Side& hint) noexcept {
  if (!exists(body_, hint)) return false;
  if (hint.kind == FeatureKind::kVertex) {
    place_at_vertex(hint.feature);
    return true;
  }
  if (!is_a_point(hint.point)) return false;
  if (hint.kind == FeatureKind::kEdge) {
    place_on_edge(hint.feature, hint.point);
    return true;
  }
  const Facet& f = body_.facets[hint.feature];
  const Vec3 p = hint.point - (f.normal.dot(hint.point) - f.offset) * f.normal;
  const double tolerance = kOnFacet * (body_.bounding_radius + p.norm());
  if (crossed_limit(body_, f, p, tolerance) != kNone) return false;
  place(FeatureKind::kFacet, hint.feature, p);
  return true;
}

// A hint on an unbounded body may come from another pair. Its point may be so far out that rounding
// takes it off its feature. If one of the bodies is bounded, the closest points are no farther out
// than `farthest`, so hints beyond that are not used.
void ActiveFeature::place_near(const TrackingState::Side& hint, const ActiveFeature& other,
                               double between_origins) noexcept {
  const double farthest =
      body_.bounding_radius + 2.0 * (other.body_.bounding_radius + between_origins);
  if (place_tracked(hint) && (body_.bounded() || point_L_.norm() <= farthest)) return;
  place_cold(other.point_to_a(other.body_.interior));
}

}  // namespace clearance
