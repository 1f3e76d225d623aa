// The depth search for two bounded bodies, whose points are held against many facets at a time.
#include <utility>

#include "core/depth_search.hpp"

namespace clearance {
namespace {

// Points times facets: as long as it takes to look up the farthest points of a few.
constexpr std::size_t kHeldAgainstAll = 1024;

}  // namespace

// What the points leave unsettled: the facet that is least deep, as long as it brings the goal
// nearer, or while there are few facets; its farthest point is one more to hold against all. Then
// what is left, one by one; what is found there is held against the facets beside it.
template <class Normal, class Farthest>
void DepthSearch::look_at_facets(const ConvexPolyhedron& body, DeepestPoints& points, Source source,
                                 const Normal& normal, const Farthest& farthest) noexcept {
  const std::size_t worthwhile = kHeldAgainstAll / body.facets.size();
  bool nearer = true;
  while (points.least() < settled() && (nearer || points.count() < worthwhile) && !points.full() &&
         !ended_early()) {
    const double before = best_.height;
    const std::int32_t facet = points.where_least();
    const Vec3 n = normal(facet);
    const auto [point, anchor] = farthest(n);
    points.add(point, anchor);
    improve(points.depth(facet), n, source, facet);
    nearer = best_.height < before;
    if (nearer && source == Source::kFacetOfX) main_ = points.count() - 1;
  }
  if (points.least() >= settled()) return lower_to(points.least());
  double rest;
  for (const std::int32_t facet : points.list_shallower(settled(), rest)) {
    if (ended_early()) return;
    if (points.depth(facet) < settled()) {
      const Vec3 n = normal(facet);
      const auto [point, anchor] = farthest(n);
      points.know(facet, point, anchor);
      improve(points.depth(facet), n, source, facet);
      const Facet& here = body.facets[facet];
      for (std::int32_t k = here.first_side; k < here.first_side + here.sides; ++k) {
        const EdgeUse& use = body.facet_edges[k];
        const std::int32_t other = body.edges[use.edge].facet[1 - use.side];
        if (points.depth(other) < settled()) points.know(other, point, anchor);
      }
    }
    lower_to(points.depth(facet));
  }
  lower_to(rest);
}

// A body of few corners: with all of them added, what is known at each facet is exact.
void DepthSearch::take_least(const DeepestPoints& points, Source source, const Vec3& n) noexcept {
  lower_to(points.least());
  improve(points.least(), n, source, points.where_least());
}

// Y's lowest point along the best direction so far is mostly deeper below all other facets of X
// than below that one: then it settles them all, and all arcs. Where not, the facet that it is
// least deep below has its say, and its lowest point of Y is one more to look at.
void DepthSearch::facets_of_x(DeepestPoints& of_y) noexcept {
  const auto normal = [&](std::int32_t facet) { return body_.x().facets[facet].normal; };
  if (of_y.fit(body_.y().anchors)) {
    of_y.add_all(body_.y().anchors, [&](const Vec3& p) { return body_.point_from_y(p); });
    take_least(of_y, Source::kFacetOfX, normal(of_y.where_least()));
    main_ = static_cast<std::size_t>(of_y.label(of_y.where_least()));
    return;
  }
  const auto lowest = [&](const Vec3& n) {
    const std::int32_t anchor = body_.lowest_anchor_of_y(n);
    return std::pair(body_.point_from_y(body_.y().anchors[anchor]), anchor);
  };
  const auto [point, anchor] = lowest(best_.source == Source::kNothing ? Vec3::UnitX() : best_.n);
  of_y.add(point, anchor);
  look_at_facets(body_.x(), of_y, Source::kFacetOfX, normal, lowest);
}

// The same, in Y's frame. X's middle settles those of Y that lie on its far side.
void DepthSearch::facets_of_y(DeepestPoints& of_x) noexcept {
  const auto normal = [&](std::int32_t facet) {
    return Vec3(-body_.direction_from_y(body_.y().facets[facet].normal));
  };
  if (of_x.fit(body_.x().anchors)) {
    of_x.add_all(body_.x().anchors, [&](const Vec3& p) { return body_.point_to_y(p); });
    return take_least(of_x, Source::kFacetOfY, normal(of_x.where_least()));
  }
  const auto farthest = [&](const Vec3& n) {
    const std::int32_t anchor = support(body_.x(), n).anchor;
    return std::pair(body_.point_to_y(body_.x().anchors[anchor]), anchor);
  };
  of_x.add(body_.point_to_y(body_.x().interior), kNone);
  look_at_facets(body_.y(), of_x, Source::kFacetOfY, normal, farthest);
}

// Along the arc between two facets' normals h is no less than what one point of Y has at both.
// Those that the main point does not settle are few, mostly.
void DepthSearch::arcs(DeepestPoints& of_y) noexcept {
  if (of_y.count() == 1 && of_y.least() >= settled()) return;
  lower_to(best_.height);
  const ConvexPolyhedron& x = body_.x();
  for (const std::int32_t i : of_y.mark(best_.height, main_)) {
    const Facet& facet = x.facets[i];
    for (std::int32_t k = facet.first_side; k < facet.first_side + facet.sides; ++k) {
      if (ended_early()) return;
      const EdgeUse& use = x.facet_edges[k];
      const Edge& edge = x.edges[use.edge];
      const std::int32_t other = edge.facet[1 - use.side];
      const bool seen = other < i && !of_y.main_is(other);
      if (!seen && !of_y.one_is(i, other)) arc_between(edge, of_y);
    }
  }
}

// From what is known at the ends of the arc: the lowest corner of Y there, or one nearly as low.
void DepthSearch::arc_between(const Edge& edge, const DeepestPoints& of_y) noexcept {
  const Arc arc = across(edge);
  const auto known = [&](const Vec2& at, std::int32_t facet) {
    const std::int32_t anchor = of_y.label(facet);
    const Vec3 lowest = of_y.has_all() ? of_y.point(static_cast<std::size_t>(anchor))
                                       : body_.point_from_y(body_.y().anchors[anchor]);
    return Sample{at, arc.project(arc.on_edge - lowest)};
  };
  const Vec2 end = arc.project(body_.x().facets[edge.facet[1]].normal);
  split(arc, known(Vec2(1, 0), edge.facet[0]), known(end, edge.facet[1]));
}

void DepthSearch::run_bounded() noexcept {
  DeepestPoints of_y(body_.x()), of_x(body_.y());
  facets_of_x(of_y);
  facets_of_y(of_x);
  arcs(of_y);
}

}  // namespace clearance
