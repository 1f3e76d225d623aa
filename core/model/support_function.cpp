#include "core/model/support_function.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/numerics/error_constants.hpp"

namespace clearance {
namespace {

// Below this many vertices a scan is cheaper than a climb.
constexpr std::size_t kScan = 24;

// Climbs from vertex to vertex in a direction m.
struct Climber {
  Vec3 m;
  std::int32_t at;
  // The greatest directional derivative along m of the edges that leave the vertex `at`.
  double steepest = kInfinity;
};

// Moves along the steepest edge if its derivative is positive by more than rounding, so the climb
// ends. It compares derivatives, because the heights of close vertices may round to the same. True:
// it has moved. No branches: neither the move nor the edge is predictable.
bool climb(const ConvexBody& body, Climber& climber) noexcept {
  const Vertex& vertex = body.vertices[climber.at];
  const double* four = body.outgoing.row(vertex.first_edge);
  const double x = climber.m.x(), y = climber.m.y(), z = climber.m.z();
  double greatest = -kInfinity;
  std::int32_t steepest = 0;
  for (std::int32_t first = 0; first < vertex.edges; first += 4, four += 12) {
    for (std::int32_t k = 0; k < 4; ++k) {
      const double derivative = (x * four[k] + y * four[4 + k]) + z * four[8 + k];
      const std::int32_t steeper = derivative > greatest;
      steepest ^= (steepest ^ (first + k)) & -steeper;
      greatest = std::max(greatest, derivative);
    }
  }
  const std::int32_t ascends = greatest > kDerivativeError;
  const std::int32_t to = body.neighbours[vertex.first_edge + steepest];
  climber.at ^= (climber.at ^ to) & -ascends;
  climber.steepest = greatest;
  return ascends != 0;
}

// Advances all climbers in rotation: while one waits for memory the others go on.
void climb_together(const ConvexBody& body, Climber* climbers, std::size_t count) noexcept {
  std::array<std::uint8_t, kLookedUpTogether> climbing;
  for (std::size_t i = 0; i < count; ++i) climbing[i] = static_cast<std::uint8_t>(i);
  while (count > 0) {
    std::size_t still = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint8_t which = climbing[i];
      climbing[still] = which;
      still += climb(body, climbers[which]);
    }
    count = still;
  }
}

// The vertices reached from one another by edges that are orthogonal to m within rounding. On the
// exact polytope every vertex that is not the support point has an ascending edge, and ascending
// edges lead to the support point. An edge that leaves this set descends by more than rounding. So
// no ascending path leaves it, and the support point is in it.
class NearlySupporting {
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

// An upper bound of the directional derivative along `across` over all unit directions of the cone;
// `across` is orthogonal to its lines. Every ray has at least RecessionCone::least along one
// direction. So a sum of unit length has weights of at most 1/least in total, each with at most the
// derivative of the steepest ray.
double derivative_by_rays(const RecessionCone& cone, const Vec3& across) noexcept {
  if (!(cone.least > 0.0)) return kInfinity;
  double steepest = 0.0;
  for (const Vec3& ray : cone.rays) steepest = std::max(steepest, across.dot(ray) + kSlopeError);
  return steepest / cone.least;
}

// The same bound for cones whose rays nearly cancel, for example those of a gable of a small slope.
// Suppose that all rays have derivatives along a direction near `across` that are negative by more
// than rounding. Then the tilt of `across` against that direction is a bound. The direction tried
// is just past the steepest ray.
double derivative_past_steepest(const RecessionCone& cone, const Vec3& across) noexcept {
  const auto steeper = [&](const Vec3& r, const Vec3& s) { return across.dot(r) < across.dot(s); };
  const auto steepest = std::max_element(cone.rays.begin(), cone.rays.end(), steeper);
  if (steepest == cone.rays.end()) return kInfinity;
  const Vec3 ray_across = cone.across_lines(*steepest);
  const double step =
      (std::max(0.0, across.dot(ray_across)) + 2.0 * kSlopeError) / ray_across.squaredNorm();
  const Vec3 past = cone.across_lines(across - step * ray_across);
  for (const Vec3& ray : cone.rays) {
    if (!(past.dot(ray) <= -kSlopeError)) return kInfinity;
  }
  return (across - past).norm();
}

// An upper bound of the directional derivative along m over all unit directions of the cone. It
// adds that of the lines and that of the rays across the lines.
double cone_derivative(const RecessionCone& cone, const Vec3& m,
                       double (*of_rays)(const RecessionCone&, const Vec3&) noexcept) noexcept {
  const Vec3 across = cone.across_lines(m);
  const double of_lines = cone.line_count > 0 ? (m - across).norm() + kSlopeError : 0.0;
  return of_rays(cone, across) + of_lines;
}

// The same bound from the facets. No direction of the cone has a positive derivative along a
// facet's normal. So its derivative along m is at most the tilt of m against that normal.
double derivative_by_facets(const ConvexBody& body, const Vec3& m) noexcept {
  double tilt2 = kInfinity;
  for (const Facet& facet : body.facets) {
    tilt2 = std::min(tilt2, (m - facet.normal).squaredNorm());
  }
  return std::sqrt(tilt2) + kSlopeError;
}

}  // namespace

Support support_by_scan(const ConvexBody& body, const Vec3& m) noexcept {
  Support best{m.dot(body.anchors[0]), 0};
  for (std::size_t i = 1; i < body.anchors.size(); ++i) {
    const double value = m.dot(body.anchors[i]);
    if (value > best.value) best = {value, static_cast<std::int32_t>(i)};
  }
  return best;
}

Support support(const ConvexBody& body, const Vec3& m) noexcept {
  assert(is_unit_or_unknown(m));
  if (!body.bounded() || body.anchors.size() <= kScan) return support_by_scan(body, m);
  Climber climber{m, body.start.at(m)};
  while (climb(body, climber)) continue;
  if (climber.steepest < -kDerivativeError) {
    return {m.dot(body.vertices[climber.at].position), climber.at};
  }
  NearlySupporting candidates;
  candidates.add(climber.at);
  Support best{-kInfinity, 0};
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const Vertex& vertex = body.vertices[candidates[k]];
    const double value = m.dot(vertex.position);
    if (value > best.value) best = {value, candidates[k]};
    for (std::int32_t i = 0; i < vertex.edges; ++i) {
      const std::int32_t next = body.neighbours[vertex.first_edge + i];
      const double derivative = m.dot(body.outgoing_of(vertex, i));
      if (derivative > -kDerivativeError && !candidates.add(next)) return support_by_scan(body, m);
    }
  }
  return best;
}

// A point is a point of the hull of the `anchors` plus a sum of rays. Its parts along and across
// the lines are no longer than the sum.
double support_along_rays(const ConvexBody& body, const Vec3& m, double within) noexcept {
  if (body.bounded()) return 0.0;
  const RecessionCone& cone = body.recession_cone;
  double rate = cone_derivative(cone, m, derivative_by_rays);
  if (rate > kSlopeError) {
    rate = std::min(
        {rate, cone_derivative(cone, m, derivative_past_steepest), derivative_by_facets(body, m)});
  }
  return rate * (within + body.bounding_radius);
}

void look_up_support_points(const ConvexBody& body, const ConvexBody& other, const Mat3& rotation,
                            std::span<const std::uint16_t> facets,
                            std::uint16_t* vertices) noexcept {
  std::array<Climber, kLookedUpTogether> climbers;
  for (std::size_t k = 0; k < facets.size(); ++k) {
    const Vec3 m = -(rotation * body.facets[facets[k]].normal);
    climbers[k] = {m, other.start.at(m)};
  }
  climb_together(other, climbers.data(), facets.size());
  for (std::size_t k = 0; k < facets.size(); ++k) {
    vertices[facets[k]] = static_cast<std::uint16_t>(climbers[k].at);
  }
}

}  // namespace clearance
