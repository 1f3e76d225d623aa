#include "core/penetration/normal_search.hpp"

#include <algorithm>
#include <cmath>

namespace clearance {
namespace {

// Parts of one arc that wait their turn. A split leaves one behind, and the other shrinks by a
// vertex of Y's outline at least; on the hard cases of tests/ no more than 4 have ever waited.
constexpr std::size_t kWaiting = 48;
// Samples of one arc, or as many as Y has vertices: more than are on its outline.
constexpr std::size_t kSamples = 1024;

// Does the body go on for ever along n? For certain; or as far as rounding can tell.
bool rises(const ConvexPolyhedron& body, const Vec3& n, double margin) noexcept {
  const auto rise = [&](const Vec3& way) { return n.dot(way) > margin * way.norm(); };
  return rise(body.recession_cone.inwards) ||
         std::any_of(body.rays.begin(), body.rays.end(),
                     [&](const Ray& ray) { return rise(ray.direction); });
}
bool may_rise(const ConvexPolyhedron& body, const Vec3& n, double margin) noexcept {
  return rises(body, n, -margin);
}

// Positive: v lies to the left of u.
double turn(const Eigen::Vector2d& u, const Eigen::Vector2d& v) noexcept {
  return u.x() * v.y() - u.y() * v.x();
}

// Between two directions less than half a turn apart, r to the left of l.
Eigen::Vector2d middle_of(const Eigen::Vector2d& l, const Eigen::Vector2d& r) noexcept {
  const Eigen::Vector2d sum = l + r;
  return sum.squaredNorm() > 1e-3 ? sum.normalized() : Eigen::Vector2d(-l.y(), l.x());
}

}  // namespace

std::size_t DepthSearch::cell(const Vec3& n) noexcept {
  const double x = std::abs(n.x()), y = std::abs(n.y()), z = std::abs(n.z());
  const int axis = x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
  return static_cast<std::size_t>(axis * 8 + (n.x() < 0.0) * 4 + (n.y() < 0.0) * 2 + (n.z() < 0.0));
}

void DepthSearch::improve(double height, const Vec3& n, Source source,
                          std::int32_t facet) noexcept {
  const bool held = steady_ > 0.0 && is_held(n);
  if (!(height < best_.height - (held ? 0.0 : steady_))) return;
  best_ = {height, n, source, facet};
  if (!held) steady_ = 0.0;
}

void DepthSearch::guess(const Vec3& n, std::int32_t edge_of_x) noexcept {
  if (may_rise(body_.x(), n, level_) || may_rise(body_.y(), -body_.direction_to_y(n), level_)) {
    return;
  }
  if (edge_of_x != kNone && body_.y().bounded()) {
    const Arc arc = across(body_.x().edges[edge_of_x]);
    const Vec2 at = unit_along(arc.project(n));
    if (within(arc, at)) {
      hold(n);
      (void)sample(arc, at);
      return;
    }
  }
  const Vec3 on_x = body_.x().anchors[support(body_.x(), n).anchor];
  const Vec3 corner = body_.corner(on_x, n);
  const std::size_t slot = cell(n);
  corners_[slot] = corner;
  has_corner_[slot] = true;
  improve(corner.dot(n) + 2.0 * tight_, n, Source::kGuess, kNone);
}

bool DepthSearch::within(const Arc& arc, const Vec2& at) const noexcept {
  if (arc.edge.facet[0] == kNone) return true;
  const Vec2 end = arc.project(body_.x().facets[arc.edge.facet[1]].normal);
  return at.y() > 0.0 && at.x() * end.y() > at.y() * end.x();
}

void DepthSearch::look_at_facet_of_x(std::int32_t index) noexcept {
  const Facet& facet = body_.x().facets[index];
  const Vec3& n = facet.normal;
  if (!body_.y().bounded() && rises(body_.y(), -body_.direction_to_y(n), certain_)) return;
  const std::size_t slot = cell(n);
  if (has_corner_[slot] && corners_[slot].dot(n) >= best_.height) return;
  corners_[slot] = body_.corner(body_.x().point_of(facet), n);
  has_corner_[slot] = true;
  const double height = corners_[slot].dot(n);
  lower_to(height);
  improve(height, n, Source::kFacetOfX, index);
}

void DepthSearch::look_at_facet_of_y(std::int32_t index) noexcept {
  const Facet& facet = body_.y().facets[index];
  const Vec3 n = -body_.direction_from_y(facet.normal);
  if (rises(body_.x(), n, certain_)) return;
  const std::size_t slot = cell(n);
  if (has_corner_[slot] && corners_[slot].dot(n) >= best_.height) return;
  corners_[slot] = body_.corner_on_x(body_.y().point_of(facet), n);
  has_corner_[slot] = true;
  const double height = corners_[slot].dot(n);
  lower_to(height);
  // On the rim of what an unbounded X allows, X's own arcs have it more accurately.
  if (!may_rise(body_.x(), n, level_)) improve(height, n, Source::kFacetOfY, index);
}

void DepthSearch::facets_of_x() noexcept {
  const auto count = static_cast<std::int32_t>(body_.x().facets.size());
  for (std::int32_t i = 0; i < count && !ended_early(); ++i) look_at_facet_of_x(i);
}

void DepthSearch::facets_of_y() noexcept {
  const auto count = static_cast<std::int32_t>(body_.y().facets.size());
  for (std::int32_t i = 0; i < count && !ended_early(); ++i) look_at_facet_of_y(i);
}

DepthSearch::Sample DepthSearch::sample(const Arc& arc, const Vec2& at) noexcept {
  const Vec3 n = arc.direction(at);
  const std::size_t slot = cell(n);
  corners_[slot] = body_.corner(arc.on_edge, n);
  has_corner_[slot] = true;
  const Sample found{at, arc.project(corners_[slot])};
  improve(found.height(), n, Source::kArc, kNone);
  return found;
}

void DepthSearch::split(const Arc& arc, const Sample& first, const Sample& last) noexcept {
  struct Part {
    Sample l, r;
  };
  std::array<Part, kWaiting> waiting;
  std::size_t count = 1;
  waiting[0] = {first, last};
  for (std::size_t samples = 0; count > 0;) {
    const Part part = waiting[--count];
    const Sample &l = part.l, &r = part.r;
    const double bound = std::max(std::min(l.height(), l.corner.dot(r.at)),
                                  std::min(r.height(), r.corner.dot(l.at)));
    if (bound >= goal()) {
      lower_to(bound);
      continue;
    }
    const Vec2 between = r.corner - l.corner;
    Vec2 m = unit_along(Vec2(-between.y(), between.x()));
    if (turn(l.at, m) < 0.0) m = -m;
    // What rounding puts beyond the arc's end shows that the bounds do not cross on it.
    if (!(turn(l.at, m) > 0.0 && turn(m, r.at) > 0.0)) {
      lower_to(bound);
      continue;
    }
    const Sample middle = sample(arc, m);
    const double crossing = std::min(l.corner.dot(middle.at), r.corner.dot(middle.at));
    const bool enough = ++samples > kSamples && samples > body_.y().anchors.size();
    if (middle.height() - crossing <= tight_ || count + 2 > kWaiting || enough) {
      lower_to(std::min({l.height(), crossing, r.height()}));
      continue;
    }
    waiting[count++] = {middle, r};
    waiting[count++] = {l, middle};
  }
}

// All directions from l to r, less than half a turn.
void DepthSearch::settle(const Arc& arc, const Vec2& l, const Vec2& r) noexcept {
  // Both tests are for the whole arc: c.n at least the smaller one of c.l and c.r.
  const auto settled_by = [&](const Vec2& corner) {
    const double bound = std::min(corner.dot(l), corner.dot(r));
    if (!(bound >= goal())) return false;
    lower_to(bound);
    return true;
  };
  const Vec2 middle = middle_of(l, r);
  const std::size_t slot = cell(arc.direction(middle));
  if (has_corner_[slot] && settled_by(arc.project(corners_[slot]))) return;
  const Sample m = sample(arc, middle);
  if (settled_by(m.corner)) return;
  const Sample from_l = sample(arc, l);
  if (settled_by(from_l.corner)) return;
  const Sample from_r = sample(arc, r);
  if (settled_by(from_r.corner)) return;
  split(arc, from_l, m);
  if (!ended_early()) split(arc, m, from_r);
}

DepthSearch::Arc DepthSearch::across(const Edge& edge) const noexcept {
  if (edge.facet[0] == kNone) {
    const Vec3 u = edge.direction.unitOrthogonal();
    return {u, edge.direction.cross(u), edge.point, edge};
  }
  return {body_.x().facets[edge.facet[0]].normal, -edge.inward.row(0), edge.point, edge};
}

// A segment's only edge: all directions across it.
void DepthSearch::full_circle(const Edge& edge) noexcept {
  const std::array<Vec2, 5> quarters = {Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1),
                                        Vec2(1, 0)};
  for (std::size_t i = 0; i < 4; ++i) settle(across(edge), quarters[i], quarters[i + 1]);
}

void DepthSearch::arc_of(const Edge& edge) noexcept {
  const Arc arc = across(edge);
  settle(arc, Vec2(1, 0), arc.project(body_.x().facets[edge.facet[1]].normal));
}

void DepthSearch::arcs() noexcept {
  for (const Edge& edge : body_.x().edges) {
    if (ended_early()) return;
    if (edge.facet[0] == kNone) {
      full_circle(edge);
    } else {
      arc_of(edge);
    }
  }
}

void DepthSearch::run() noexcept {
  const auto fits = [](const ConvexPolyhedron& body) {
    return body.bounded() && !body.facets.empty() && DeepestPoints::fits(body);
  };
  if (fits(body_.x()) && fits(body_.y())) return run_bounded();
  facets_of_x();
  facets_of_y();
  arcs();
}

}  // namespace clearance
