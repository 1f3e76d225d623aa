// Compiled once a vector width.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/model/support_function.cpp"
#include "core/numerics/simd_targets.hpp"
// That comes first.
#include "core/model/edge_scan-inl.hpp"
#include "core/model/support_function.hpp"
#include "core/numerics/error_constants.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// Along the edges that rise for certain, so that it ends. certain: where every edge falls.
std::int32_t climb(const ConvexPolyhedron& body, const Vec3& m, std::int32_t at, bool& certain) {
  for (;;) {
    const SteepestEdge way = steepest(body, body.vertices[at], m);
    certain = way.derivative < -kDerivativeError;
    if (!(way.derivative > kDerivativeError)) return at;
    at = body.neighbours[way.at];
  }
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>
#include <array>
#include <cmath>

namespace clearance {

HWY_EXPORT(climb);

namespace {

// Below this many vertices a scan is cheaper than a climb.
constexpr std::size_t kScan = 24;

// The vertices reached from one another by edges that rounding cannot tell from level ones. On the
// exact polytope every vertex that is not the highest has a rising edge, and rising edges lead to
// the highest. An edge that leaves this set falls for certain, so no rising path leaves it: the
// highest vertex is in it.
class LevelSet {
 public:
  bool add(std::int32_t vertex) noexcept {
    for (std::size_t i = 0; i < size_; ++i) {
      if (members_[i] == vertex) return true;
    }
    if (size_ == members_.size()) return false;
    members_[size_++] = vertex;
    return true;
  }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  std::int32_t operator[](std::size_t i) const noexcept { return members_[i]; }

 private:
  std::array<std::int32_t, 96> members_;
  std::size_t size_ = 0;
};

struct Neighbour {
  std::int32_t vertex;
  double slope;  // of the edge that leads there, along m
};

Neighbour neighbour(const ConvexPolyhedron& body, const EdgeUse& use, const Vec3& m) noexcept {
  const Edge& edge = body.edges[use.edge];
  const double along = edge.direction.dot(m);
  return {edge.vertex[1 - use.side], use.side == 0 ? along : -along};
}

// How fast a sum of rays that are no lines may rise, at most, along a direction across the lines.
// Their parts across the lines all have a part of at least Opening::least along one direction, so
// that there are no more of them than the sum is long over that: they count as often as the
// steepest rises.
double rise_of_rays(const Opening& opening, const Vec3& across) noexcept {
  if (!(opening.least > 0.0)) return kInfinity;
  double steepest = 0.0;
  for (const Vec3& ray : opening.rays) steepest = std::max(steepest, across.dot(ray) + kSlopeError);
  return steepest / opening.least;
}

// The same by a direction beside it along which all rays fall for certain: they rise no faster than
// it is tilted against that one. Where only the steepest ray does not fall, it leads past that.
double rise_past_steepest(const Opening& opening, const Vec3& across) noexcept {
  const auto steeper = [&](const Vec3& r, const Vec3& s) { return across.dot(r) < across.dot(s); };
  const auto steepest = std::max_element(opening.rays.begin(), opening.rays.end(), steeper);
  if (steepest == opening.rays.end()) return kInfinity;
  const Vec3 way = opening.across_lines(*steepest);
  const double step = (std::max(0.0, across.dot(way)) + 2.0 * kSlopeError) / way.squaredNorm();
  const Vec3 past = opening.across_lines(across - step * way);
  for (const Vec3& ray : opening.rays) {
    if (!(past.dot(ray) <= -kSlopeError)) return kInfinity;
  }
  return (across - past).norm();
}

// How fast an opening's sums may rise along m, at most: along its lines, and beside them as its
// rays may along a direction across the lines.
double rise(const Opening& opening, const Vec3& m,
            double (*of_rays)(const Opening&, const Vec3&) noexcept) noexcept {
  const Vec3 across = opening.across_lines(m);
  const double of_lines = opening.line_count > 0 ? (m - across).norm() + kSlopeError : 0.0;
  return of_rays(opening, across) + of_lines;
}

// How fast a body may rise along m, at most, by its facets: nothing rises along their normals, and
// along m no faster than m is tilted against one. It says more of bodies that are all but a
// half-space.
double rise_above_facets(const ConvexPolyhedron& body, const Vec3& m) noexcept {
  double tilt2 = kInfinity;
  for (const Facet& facet : body.facets) {
    tilt2 = std::min(tilt2, (m - facet.normal).squaredNorm());
  }
  return std::sqrt(tilt2) + kSlopeError;
}

}  // namespace

Support support_by_scan(const ConvexPolyhedron& body, const Vec3& m) noexcept {
  Support best{m.dot(body.anchors[0]), 0};
  for (std::size_t i = 1; i < body.anchors.size(); ++i) {
    const double height = m.dot(body.anchors[i]);
    if (height > best.reach) best = {height, static_cast<std::int32_t>(i)};
  }
  return best;
}

Support support(const ConvexPolyhedron& body, const Vec3& m) noexcept {
  if (!body.bounded() || body.anchors.size() <= kScan) return support_by_scan(body, m);
  bool certain;
  const std::int32_t top = HWY_DYNAMIC_DISPATCH(climb)(body, m, body.start.at(m), certain);
  if (certain) return {m.dot(body.vertices[top].position), top};
  LevelSet level;
  level.add(top);
  Support best{-kInfinity, 0};
  for (std::size_t k = 0; k < level.size(); ++k) {
    const Vertex& vertex = body.vertices[level[k]];
    const double height = m.dot(vertex.position);
    if (height > best.reach) best = {height, level[k]};
    for (std::int32_t i = 0; i < vertex.edges; ++i) {
      const Neighbour n = neighbour(body, body.vertex_edges[vertex.first_edge + i], m);
      if (n.slope > -kDerivativeError && !level.add(n.vertex)) return support_by_scan(body, m);
    }
  }
  return best;
}

// A point is an anchor plus a sum of rays; what of it lies along lines, and what across, is no
// longer than the sum.
double reach_along_rays(const ConvexPolyhedron& body, const Vec3& m, double within) noexcept {
  if (body.bounded()) return 0.0;
  const Opening& opening = body.opening;
  double rate = rise(opening, m, rise_of_rays);
  if (rate > kSlopeError) {
    rate = std::min({rate, rise(opening, m, rise_past_steepest), rise_above_facets(body, m)});
  }
  return rate * (within + body.bounding_radius);
}

}  // namespace clearance
#endif
