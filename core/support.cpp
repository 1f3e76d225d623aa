#include "core/support.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/double_double.hpp"

namespace clearance {
namespace {

// Below this many vertices a scan is cheaper than a climb.
constexpr std::size_t kScan = 24;

// Unit edge directions are off by 2^-52, their products with a unit vector by three roundings more:
// an edge that falls by more than this (per unit length) falls in exact arithmetic.
constexpr double kFalls = 0x1p-50;

// Rays nearer to parallel than this (an angle) are a bundle.
constexpr double kBundle = 0x1p-45;

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

std::int32_t climb(const ConvexPolyhedron& body, const Vec3& m, std::int32_t at) noexcept {
  double height = m.dot(body.vertices[at].position);
  while (true) {
    std::int32_t next = at;
    const Vertex& vertex = body.vertices[at];
    for (std::int32_t i = 0; i < vertex.edges; ++i) {
      const std::int32_t to = neighbour(body, body.vertex_edges[vertex.first_edge + i], m).vertex;
      const double there = m.dot(body.vertices[to].position);
      if (there > height) {
        height = there;
        next = to;
      }
    }
    if (next == at) return at;
    at = next;
  }
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
  LevelSet level;
  level.add(climb(body, m, body.start.at(m)));
  Support best{-kInfinity, 0};
  for (std::size_t k = 0; k < level.size(); ++k) {
    const Vertex& vertex = body.vertices[level[k]];
    const double height = m.dot(vertex.position);
    if (height > best.reach) best = {height, level[k]};
    for (std::int32_t i = 0; i < vertex.edges; ++i) {
      const Neighbour n = neighbour(body, body.vertex_edges[vertex.first_edge + i], m);
      if (n.slope > -kFalls && !level.add(n.vertex)) return support_by_scan(body, m);
    }
  }
  return best;
}

namespace {

// How the rays span their cone: any of its vectors x is a sum of mu_j r_j with sum mu_j <=
// condition * |x|. Opposite rays span lines (at most two); the others lie strictly to one side of
// some plane.
double ray_condition(const ConvexPolyhedron& body) noexcept {
  const auto& rays = body.rays;
  std::array<Vec3, 2> lines;
  std::size_t line_count = 0;
  Vec3 middle = Vec3::Zero();
  const auto is_line = [&](const Vec3& r) {
    return std::any_of(rays.begin(), rays.end(), [&](const Ray& o) { return o.direction == -r; });
  };
  for (const Ray& ray : rays) {
    if (is_line(ray.direction) && line_count < 2 &&
        (line_count == 0 || (lines[0] != -ray.direction.normalized()))) {
      lines[line_count++] = ray.direction.normalized();
    }
  }
  // No ray leads out of a facet and only lines run along all of them: against the sum of the
  // normals every other ray has a part, where against the sum of the rays one of many may have
  // none.
  for (const Facet& facet : body.facets) middle -= facet.normal;
  const double skew = line_count == 2 ? lines[0].cross(lines[1]).norm() : 1.0;
  for (std::size_t i = 0; i < line_count; ++i) middle -= middle.dot(lines[i]) * lines[i];
  const double of_lines = line_count == 0 ? 0.0 : line_count == 1 ? 1.0 : 1.5 / skew;
  double opening = kInfinity;  // least component of a pointed ray along `middle`
  const double length = middle.norm();
  for (const Ray& ray : rays) {
    if (is_line(ray.direction)) continue;
    opening = std::min(opening, middle.dot(ray.direction.normalized()) / length);
  }
  if (!(opening > 0.0)) return kInfinity;
  return 1.0 / opening + of_lines * (1.0 + 1.0 / opening);
}

// The sign of m.r, exactly.
int exact_sign(const Vec3& m, const Vec3& r) noexcept {
  const DoubleDouble sum =
      exact::product(m.x(), r.x()) + exact::product(m.y(), r.y()) + exact::product(m.z(), r.z());
  const double error =
      0x1p-100 * (std::abs(m.x() * r.x()) + std::abs(m.y() * r.y()) + std::abs(m.z() * r.z()));
  if (sum.high > error) return 1;
  if (sum.high < -error) return -1;
  // Two products that cancel exactly, or none: those cases, and only those, are certain.
  const bool certain =
      (m.x() * r.x() == 0.0) + (m.y() * r.y() == 0.0) + (m.z() * r.z() == 0.0) >= 1;
  return certain && sum.high == 0.0 && sum.low == 0.0 ? 0 : 1;
}

}  // namespace

double reach_along_rays(const ConvexPolyhedron& body, const Vec3& m, double within) noexcept {
  if (body.bounded()) return 0.0;
  double steepest = 0.0;
  for (const Ray& ray : body.rays) {
    const double length = ray.exact ? ray.direction.norm() : 1.0;
    steepest = std::max(steepest, m.dot(ray.direction) / length);
  }
  // The rays' directions and the product are off by at most 2^-50.
  return (steepest + 0x1p-50) * ray_condition(body) * (within + body.bounding_radius);
}

LevelRays level_rays(const ConvexPolyhedron& body, const Vec3& m, double margin) noexcept {
  LevelRays level;
  bool both_ways = false;
  for (const Ray& ray : body.rays) {
    const double slope = m.dot(ray.direction) / ray.direction.norm();
    if (slope < -margin) continue;
    const bool across = ray.exact && exact_sign(m, ray.direction) <= 0;
    level.exactly_level = level.exactly_level && across;
    const Vec3 direction = ray.direction.normalized();
    if (level.directions == 0) {
      level.directions = 1;
      level.direction = direction;
    }
    const double apart = (direction - level.direction).norm();
    if (apart <= kBundle) {
      level.spread = std::max(level.spread, apart);
    } else {
      both_ways = true;
      if (direction != -level.direction) level.directions = 2;
    }
    if (slope > margin) level.directions = 2;
  }
  if (both_ways && level.spread > 0.0) level.directions = 2;
  return level;
}

}  // namespace clearance
