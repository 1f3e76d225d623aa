#include "core/penetration/normal_search.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace clearance {
namespace {

// The most parts of one arc that may wait. A split leaves one part waiting, and the other shrinks
// by at least a vertex of Y's outline. On the hard cases of tests/ no more than 4 have ever waited.
constexpr std::size_t kWaiting = 48;
// Samples of one arc, or as many as Y has vertices: more than are on its outline.
constexpr std::size_t kSamples = 1024;

// Is the body unbounded along n? It is if one of its rays has a directional derivative above
// `margin`.
bool is_unbounded_along(const ConvexBody& body, const Vec3& n, double margin) noexcept {
  const auto is_above = [&](const Vec3& ray) { return n.dot(ray) > margin * ray.norm(); };
  return is_above(body.recession_cone.inwards) ||
         std::any_of(body.rays.begin(), body.rays.end(),
                     [&](const Ray& ray) { return is_above(ray.direction); });
}

// Positive: v lies to the left of u.
double cross(const Eigen::Vector2d& u, const Eigen::Vector2d& v) noexcept {
  return u.x() * v.y() - u.y() * v.x();
}

// Between two directions at an angle below pi, r to the left of l.
Eigen::Vector2d middle_of(const Eigen::Vector2d& l, const Eigen::Vector2d& r) noexcept {
  const Eigen::Vector2d sum = l + r;
  return sum.squaredNorm() > 1e-3 ? sum.normalized() : Eigen::Vector2d(-l.y(), l.x());
}

}  // namespace

std::size_t NormalSearch::cell(const Vec3& n) noexcept {
  const double x = std::abs(n.x()), y = std::abs(n.y()), z = std::abs(n.z());
  const int axis = x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
  return static_cast<std::size_t>(axis * 8 + (n.x() < 0.0) * 4 + (n.y() < 0.0) * 2 + (n.z() < 0.0));
}

void NormalSearch::improve(double height, const Vec3& n, Source source,
                           std::int32_t facet) noexcept {
  const bool preferred = preference_ > 0.0 && is_preferred(n);
  if (!(height < best_.height - (preferred ? 0.0 : preference_))) return;
  best_ = {height, n, source, facet};
  if (!preferred) preference_ = 0.0;
}

void NormalSearch::guess(const Vec3& n, std::int32_t edge_of_x) noexcept {
  assert(is_unit_or_unknown(n));
  if (is_unbounded_along(body_.x(), n, -within_rounding_)) return;
  if (edge_of_x != kNone) {
    const Arc arc = across(body_.x().edges[edge_of_x]);
    const Vec2 at = unit_along(arc.project(n));
    if (within(arc, at)) {
      prefer(n);
      (void)sample(arc, at);
      return;
    }
  }
  const Vec3 on_x = body_.x().anchors[support(body_.x(), n).anchor];
  improve(cache(n, body_.support_point(on_x, n)).dot(n) + 2.0 * gap_tolerance_, n, Source::kGuess,
          kNone);
}

bool NormalSearch::within(const Arc& arc, const Vec2& at) const noexcept {
  if (arc.edge.facet[0] == kNone) return true;
  const Vec2 end = arc.project(body_.x().facets[arc.edge.facet[1]].normal);
  return at.y() > 0.0 && at.x() * end.y() > at.y() * end.x();
}

bool NormalSearch::may_be_lowest_along(const Vec3& n) const noexcept {
  const Vec3* vertex = cached(n);
  return vertex == nullptr || !(vertex->dot(n) >= best_.height);
}

void NormalSearch::look_at_facet_of_x(std::int32_t index) noexcept {
  const Facet& facet = body_.x().facets[index];
  const Vec3& n = facet.normal;
  if (!may_be_lowest_along(n)) return;
  const double height = cache(n, body_.support_point(body_.x().point_of(facet), n)).dot(n);
  lower_to(height);
  improve(height, n, Source::kFacetOfX, index);
}

void NormalSearch::look_at_facet_of_y(std::int32_t index) noexcept {
  const Facet& facet = body_.y().facets[index];
  const Vec3 n = -body_.direction_from_y(facet.normal);
  if (is_unbounded_along(body_.x(), n, beyond_rounding_) || !may_be_lowest_along(n)) return;
  const double height = cache(n, body_.support_point_on_x(body_.y().point_of(facet), n)).dot(n);
  lower_to(height);
  // At the boundary of the directions along which X is bounded, X's own arcs are more accurate.
  if (!is_unbounded_along(body_.x(), n, -within_rounding_)) {
    improve(height, n, Source::kFacetOfY, index);
  }
}

void NormalSearch::facets_of_x() noexcept {
  const auto count = static_cast<std::int32_t>(body_.x().facets.size());
  for (std::int32_t i = 0; i < count && !ended_early(); ++i) look_at_facet_of_x(i);
}

void NormalSearch::facets_of_y() noexcept {
  const auto count = static_cast<std::int32_t>(body_.y().facets.size());
  for (std::int32_t i = 0; i < count && !ended_early(); ++i) look_at_facet_of_y(i);
}

NormalSearch::Sample NormalSearch::sample(const Arc& arc, const Vec2& at) noexcept {
  const Vec3 n = arc.direction(at);
  const Sample found{at, arc.project(cache(n, body_.support_point(arc.on_edge, n)))};
  improve(found.height(), n, Source::kArc, kNone);
  return found;
}

void NormalSearch::split(const Arc& arc, const Sample& first, const Sample& last) noexcept {
  struct Part {
    Sample l, r;
  };
  std::array<Part, kWaiting> waiting;
  std::size_t count = 1;
  waiting[0] = {first, last};
  for (std::size_t samples = 0; count > 0;) {
    const Part part = waiting[--count];
    const Sample &l = part.l, &r = part.r;
    const double bound = std::max(std::min(l.height(), l.vertex.dot(r.at)),
                                  std::min(r.height(), r.vertex.dot(l.at)));
    if (bound >= height_to_reach()) {
      lower_to(bound);
      continue;
    }
    const Vec2 between = r.vertex - l.vertex;
    Vec2 m = unit_along(Vec2(-between.y(), between.x()));
    if (cross(l.at, m) < 0.0) m = -m;
    // If rounding puts the crossing past the arc's end, the bounds do not cross on the arc.
    if (!(cross(l.at, m) > 0.0 && cross(m, r.at) > 0.0)) {
      lower_to(bound);
      continue;
    }
    const Sample middle = sample(arc, m);
    const double crossing = std::min(l.vertex.dot(middle.at), r.vertex.dot(middle.at));
    const bool enough = ++samples > kSamples && samples > body_.y().anchors.size();
    if (middle.height() - crossing <= gap_tolerance_ || count + 2 > kWaiting || enough) {
      lower_to(std::min({l.height(), crossing, r.height()}));
      continue;
    }
    waiting[count++] = {middle, r};
    waiting[count++] = {l, middle};
  }
}

// All directions from l to r, less than half a turn apart.
void NormalSearch::bound_arc(const Arc& arc, const Vec2& l, const Vec2& r) noexcept {
  // Both tests are for the whole arc: c.n at least the smaller one of c.l and c.r.
  const auto bounded_by = [&](const Vec2& vertex) {
    const double bound = std::min(vertex.dot(l), vertex.dot(r));
    if (!(bound >= height_to_reach())) return false;
    lower_to(bound);
    return true;
  };
  const Vec2 middle = middle_of(l, r);
  const Vec3* known = cached(arc.direction(middle));
  if (known != nullptr && bounded_by(arc.project(*known))) return;
  const Sample m = sample(arc, middle);
  if (bounded_by(m.vertex)) return;
  const Sample from_l = sample(arc, l);
  if (bounded_by(from_l.vertex)) return;
  const Sample from_r = sample(arc, r);
  if (bounded_by(from_r.vertex)) return;
  split(arc, from_l, m);
  if (!ended_early()) split(arc, m, from_r);
}

NormalSearch::Arc NormalSearch::across(const Edge& edge) const noexcept {
  if (edge.facet[0] == kNone) {
    const Vec3 u = edge.direction.unitOrthogonal();
    return {u, edge.direction.cross(u), edge.point, edge};
  }
  return {body_.x().facets[edge.facet[0]].normal, -edge.inward.row(0), edge.point, edge};
}

// A segment's only edge: all directions across it.
void NormalSearch::full_circle(const Edge& edge) noexcept {
  const std::array<Vec2, 5> quarters = {Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1),
                                        Vec2(1, 0)};
  for (std::size_t i = 0; i < 4; ++i) bound_arc(across(edge), quarters[i], quarters[i + 1]);
}

void NormalSearch::arc_of(const Edge& edge) noexcept {
  const Arc arc = across(edge);
  bound_arc(arc, Vec2(1, 0), arc.project(body_.x().facets[edge.facet[1]].normal));
}

void NormalSearch::arcs() noexcept {
  for (const Edge& edge : body_.x().edges) {
    if (ended_early()) return;
    if (edge.facet[0] == kNone) {
      full_circle(edge);
    } else {
      arc_of(edge);
    }
  }
}

void NormalSearch::run() noexcept {
  const auto fits = [](const ConvexBody& body) {
    return body.bounded() && !body.facets.empty() && DeepestPoints::fits(body);
  };
  if (fits(body_.x()) && fits(body_.y())) {
    run_bounded();
  } else {
    facets_of_x();
    facets_of_y();
    arcs();
  }
  assert(ended_early() || lower_ <= best_.height + 2.0 * gap_tolerance_);
}

}  // namespace clearance
