// The depth search for two bounded bodies. It compares points with many facets at a time.
#include <algorithm>
#include <cassert>

#include "core/model/support_function.hpp"
#include "core/penetration/gauss_arc.hpp"
#include "core/penetration/normal_search.hpp"

namespace clearance {
namespace {

// Comparing points with all facets takes as long as kFew look-ups, plus one for every
// kFacetsALookUp facets.
constexpr std::size_t kFew = 16, kFacetsALookUp = 32;
std::size_t few_of(const ConvexBody& body) noexcept {
  return kFew + body.facets.size() / kFacetsALookUp;
}

}  // namespace

// For a body of few vertices: all of them are compared with all facets, so the depth below each
// facet is exact.
void NormalSearch::take_least(const Facing& facing, const DeepestVertices& vertices) noexcept {
  const std::int32_t facet = vertices.where_least();
  const Facet& f = facing.body.facets[facet];
  lower_to(vertices.least());
  improve(vertices.least(), facing.source == Source::kFacetOfX ? f.normal : facing.against(f),
          facing.source, facet);
}

// The vertex that is certainly the deepest below a facet.
std::int32_t NormalSearch::look_up(const Facing& facing, std::int32_t facet) noexcept {
  const Facet& f = facing.body.facets[facet];
  const Vec3 m = facing.against(f);
  const std::int32_t anchor = support(facing.other, m).anchor;
  const double depth = facing.below(f, anchor);
  lower_to(depth);
  improve(depth, facing.source == Source::kFacetOfX ? f.normal : m, facing.source, facet);
  return anchor;
}

// Bounds facets that the points leave open. The deepest vertex below the least deep facet is one
// more point to compare with all facets, as long as it makes progress. It makes hardly any if the
// direction of the last query was the first target. After that the other body's inner sphere is
// tried, and then vertices again.
DeepestPoints::Shallow NormalSearch::narrow_down(const Facing& facing,
                                                 DeepestPoints& points) noexcept {
  DeepestPoints::Shallow shallow = points.list_shallow(sufficient_height());
  bool nearer = preference_ == 0.0;
  while (shallow.facets.size() > few_of(facing.body) && !ended_early()) {
    if (nearer && points.room_beside_sphere()) {
      const double before = best_.height;
      const std::int32_t anchor = look_up(facing, shallow.where_least);
      nearer = best_.height < before;
      if (!nearer) continue;
      points.add(facing.body_from_other(facing.other.anchors[anchor]));
    } else if (points.sphere() == nullptr) {
      points.add_sphere(facing.body_from_other(facing.other.interior), facing.other.inner_radius,
                        rounding_of_place());
      nearer = true;
    } else {
      break;
    }
    shallow = points.list_shallow(sufficient_height());
  }
  return shallow;
}

// Bounds the facets that are still open. Any vertex that is deep enough bounds a facet; if
// none is known, the deepest is searched.
void NormalSearch::look_at_facets(const Facing& facing, DeepestPoints& points) noexcept {
  const DeepestPoints::Shallow shallow = narrow_down(facing, points);
  if (ended_early()) return;
  lower_to(shallow.rest);
  if (shallow.facets.size() <= few_of(facing.body)) {
    return look_at_few(facing, shallow.facets, points.vertices());
  }
  const Mat3 rotation = facing.body_from_other.rotation.transpose();
  for (std::size_t k = 0; k < shallow.facets.size() && !ended_early(); k += kLookedUpTogether) {
    const auto some =
        shallow.facets.subspan(k, std::min(kLookedUpTogether, shallow.facets.size() - k));
    look_up_support_points(facing.body, facing.other, rotation, some, points.vertices());
    for (const std::uint16_t facet : some) {
      const std::int32_t vertex = points.vertex(facet);
      if (!is_bounded(facing, facet, vertex)) {
        points.vertices()[facet] = static_cast<std::uint16_t>(look_up(facing, facet));
      }
    }
  }
}

// Bounds them one by one: the point found for one facet bounds most of its neighbours.
void NormalSearch::look_at_few(const Facing& facing, std::span<const std::uint16_t> facets,
                               std::uint16_t* vertices) noexcept {
  std::int32_t last = kNone;
  for (const std::uint16_t facet : facets) {
    if (last == kNone || !is_bounded(facing, facet, last)) last = look_up(facing, facet);
    if (ended_early()) return;
    vertices[facet] = static_cast<std::uint16_t>(last);
  }
}

// By a vertex that is deep enough.
bool NormalSearch::is_bounded(const Facing& facing, std::int32_t facet,
                              std::int32_t vertex) noexcept {
  const double depth = facing.below(facing.body.facets[facet], vertex);
  if (!(depth >= sufficient_height())) return false;
  lower_to(depth);
  return true;
}

// In Y's frame.
void NormalSearch::facets_of_y_bounded() noexcept {
  const ConvexBody& x = body_.x();
  if (!DeepestVertices::fit(x.anchors)) return facets_of_y_by_points();
  const Facing facing = y_facing_x();
  take_least(facing, DeepestVertices(body_.y(), x.anchors, facing.body_from_other));
}

// X's support point along the best direction bounds most facets of Y, and the sphere in its
// middle those on the far side.
void NormalSearch::facets_of_y_by_points() noexcept {
  const Facing facing = y_facing_x();
  const ConvexBody& x = body_.x();
  DeepestPoints of_x(body_.y());
  of_x.add_sphere(facing.body_from_other(x.interior), x.inner_radius, rounding_of_place());
  of_x.add(facing.body_from_other(x.anchors[support(x, best_.n).anchor]));
  look_at_facets(facing, of_x);
}

// Along the arc between two facets' normals h is at least the smaller of the two heights of one
// point of Y. Mostly, the main point leaves few arcs open.
void NormalSearch::arcs(DeepestVertices& of_y) noexcept {
  lower_to(best_.height);
  const ConvexBody& x = body_.x();
  for (const std::int32_t i : of_y.mark(best_.height, of_y.number(of_y.where_least()))) {
    const Facet& facet = x.facets[i];
    for (std::int32_t k = facet.first_side; k < facet.first_side + facet.sides; ++k) {
      if (ended_early()) return;
      const std::int32_t other = x.facets_beside[k];
      if ((other < i && !of_y.main_is(other)) || of_y.one_is(i, other)) continue;
      const Vec3 &below = of_y.deepest(i), &beside = of_y.deepest(other);
      if (bounds_arc(facet, below, x.facets[other], beside, nullptr)) continue;
      arc_from(x.facet_edges[k], below, beside);
    }
  }
}

// Uses the vertices known at the ends of an arc: the lowest vertex of Y there, or one nearly as
// low. Up to half of the tolerance between bounds is left for the places where one vertex takes
// over from the other.
bool NormalSearch::bounds_arc(const Facet& l, const Vec3& at_l, const Facet& r, const Vec3& at_r,
                              const DeepestPoints::Point* sphere) noexcept {
  const auto on_arc = [&](const Vec3& p) {
    return OnArc{l.offset - l.normal.dot(p), r.offset - r.normal.dot(p)};
  };
  const OnArc first = on_arc(at_l), last = on_arc(at_r);
  double bound = -kInfinity;
  const OnArc middle = sphere != nullptr ? on_arc(sphere->at) : OnArc{};
  if (sphere != nullptr && middle.least() >= sphere->margin) {
    bound =
        least_with_sphere(first, middle, sphere->radius, last, (l.normal - r.normal).squaredNorm(),
                          best_.height + 0.5 * gap_tolerance_);
  }
  if (bound < best_.height) bound = std::max(bound, least_of_two(first, last));
  if (!(bound >= height_to_reach())) return false;
  lower_to(bound);
  return true;
}

// Begins with the same vertices.
void NormalSearch::arc_from(const EdgeUse& use, const Vec3& at_own, const Vec3& at_other) noexcept {
  const Arc arc = across(body_.x().edges[use.edge]);
  const auto known = [&](const Vec2& at, const Vec3& p) {
    const Sample there{at, arc.project(arc.on_edge - p)};
    return there.height() >= height_to_reach() ? there : sample(arc, at);
  };
  const Vec2 end = arc.project(body_.x().facets[arc.edge.facet[1]].normal);
  const bool forth = use.side == 0;
  const Sample from = known(Vec2(1, 0), forth ? at_own : at_other);
  split(arc, from, known(end, forth ? at_other : at_own));
}

void NormalSearch::few_vertices() noexcept {
  const Facing facing = x_facing_y();
  DeepestVertices of_y(body_.x(), body_.y().anchors, facing.body_from_other);
  take_least(facing, of_y);
  if (ended_early()) return;
  facets_of_y_bounded();
  if (!ended_early()) arcs(of_y);
}

// Y's lowest point along the best direction so far is mostly deeper below all other facets of X.
void NormalSearch::many_vertices() noexcept {
  const Facing facing = x_facing_y();
  DeepestPoints of_y(body_.x());
  of_y.add(body_.support_point_of_y(best_.n));
  look_at_facets(facing, of_y);
  if (ended_early()) return;
  facets_of_y_bounded();
  if (!ended_early()) arcs(of_y);
}

void NormalSearch::run_bounded() noexcept {
  assert(best_.source != Source::kNothing);  // the guess, along which bounded bodies have a height
  if (DeepestVertices::fit(body_.y().anchors)) {
    // X has no more edges than Y.
    assert(body_.x().facets.size() <= DeepestVertices::kMostScanned);
    few_vertices();
  } else {
    many_vertices();
  }
}

}  // namespace clearance
