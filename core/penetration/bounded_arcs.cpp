// The arcs of a body against another of many vertices: see core/penetration/normal_search.hpp.
#include <algorithm>

#include "core/model/support_function.hpp"
#include "core/penetration/normal_search.hpp"

namespace clearance {

// Most arcs are bounded by one point that is deep enough below both facets. It is Y's
// lowest vertex, or its inner sphere if the bodies penetrate deeply.
void NormalSearch::arcs(DeepestPoints& of_y) noexcept {
  lower_to(best_.height);
  const bool sphere = of_y.sphere() != nullptr;
  auto open = of_y.list_not_below(sphere ? *of_y.sphere() : of_y.points()[0], best_.height);
  if (sphere && open.size() > body_.x().facets.size() / 2) {
    open = of_y.list_not_below(of_y.points()[0], best_.height);
  }
  for (const std::uint16_t facet : open) {
    if (ended_early()) return;
    arcs_of(facet, of_y);
  }
}

// If both facets of an arc are listed, the first one takes it.
void NormalSearch::arcs_of(std::int32_t facet, DeepestPoints& of_y) noexcept {
  const ConvexBody& x = body_.x();
  const Facet& here = x.facets[facet];
  const Vec3 vertex = deepest_vertex_below(facet, of_y);
  for (std::int32_t k = here.first_side; k < here.first_side + here.sides; ++k) {
    const std::int32_t other = x.facets_beside[k];
    if (other < facet && of_y.is_listed(other)) continue;
    const bool looked_up = of_y.vertex(facet) != DeepestPoints::kNoVertex &&
                           of_y.vertex(other) != DeepestPoints::kNoVertex;
    if (!looked_up && of_y.one_is_below(here, x.facets[other], best_.height)) continue;
    const Vec3 beside = deepest_vertex_below(other, of_y);
    if (bounds_arc(here, vertex, x.facets[other], beside, of_y.sphere())) continue;
    arc_from(x.facet_edges[k], vertex, beside);
  }
}

// Returns a vertex of Y below a facet of X. This is usually the one that was looked up for the
// facet. A facet that a sphere has bounded has none. For it, the deepest of the points
// that were compared with all facets is taken, if it is deep enough. Otherwise a vertex is looked
// up now.
Vec3 NormalSearch::deepest_vertex_below(std::int32_t facet, DeepestPoints& of_y) const noexcept {
  if (of_y.vertex(facet) == DeepestPoints::kNoVertex) {
    const Facet& here = body_.x().facets[facet];
    const DeepestPoints::Point* deepest = nullptr;
    for (const DeepestPoints::Point& point : of_y.points()) {
      if (&point == of_y.sphere()) continue;
      if (deepest == nullptr || point.below(here) > deepest->below(here)) deepest = &point;
    }
    if (deepest->below(here) >= height_to_reach()) return deepest->at;
    const std::uint16_t list[] = {static_cast<std::uint16_t>(facet)};
    look_up_support_points(body_.x(), body_.y(), body_.y_from_x().rotation, list, of_y.vertices());
  }
  return body_.point_from_y(body_.y().anchors[of_y.vertex(facet)]);
}

}  // namespace clearance
