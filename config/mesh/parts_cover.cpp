// A triangle is clipped by the facets of one part after the other. What lies outside a facet has to
// be covered by the parts that follow.
#include "config/mesh/parts_cover.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace clearance {
namespace {

constexpr double kRounding = 1e-9;  // of the largest coordinate

using Polygon = std::vector<Vec3>;

// Returns how far the point is beyond the facet's plane, m.
double excess(const Facet& facet, const Vec3& point) {
  return facet.normal.dot(point) - facet.offset;
}

// The two sides of a convex polygon that a plane cuts.
struct Halves {
  Polygon inside, outside;
};

Halves split(const Polygon& polygon, const Facet& facet, double tolerance) {
  Halves halves;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double a = excess(facet, from) - tolerance, b = excess(facet, to) - tolerance;
    (a <= 0.0 ? halves.inside : halves.outside).push_back(from);
    if ((a <= 0.0) == (b <= 0.0)) continue;
    const Vec3 crossing = from + a / (a - b) * (to - from);
    halves.inside.push_back(crossing);
    halves.outside.push_back(crossing);
  }
  return halves;
}

class Cover {
 public:
  Cover(std::span<const ConvexBody> parts, double tolerance)
      : parts_(parts), tolerance_(tolerance) {}

  // Neighbouring triangles are mostly in the same part, so the part of the last one is tried first.
  [[nodiscard]] bool holds(const Triangle& triangle) {
    if (holds_whole(parts_[last_], triangle)) return true;
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      if (!holds_whole(parts_[part], triangle)) continue;
      last_ = part;
      return true;
    }
    return holds_from(0, {triangle.begin(), triangle.end()});
  }

 private:
  [[nodiscard]] bool holds_whole(const ConvexBody& part, const Triangle& triangle) const {
    return std::ranges::all_of(part.facets, [&](const Facet& facet) {
      return std::ranges::all_of(
          triangle, [&](const Vec3& point) { return excess(facet, point) <= tolerance_; });
    });
  }

  [[nodiscard]] bool misses(const ConvexBody& part, const Polygon& polygon) const {
    return std::ranges::any_of(part.facets, [&](const Facet& facet) {
      return std::ranges::all_of(
          polygon, [&](const Vec3& point) { return excess(facet, point) > tolerance_; });
    });
  }

  // Returns true if the parts from this one on cover the polygon.
  [[nodiscard]] bool holds_from(std::size_t part, Polygon polygon) const {
    while (part < parts_.size() && misses(parts_[part], polygon)) ++part;
    if (part == parts_.size()) return false;
    for (const Facet& facet : parts_[part].facets) {
      Halves halves = split(polygon, facet, tolerance_);
      if (!halves.outside.empty() && !holds_from(part + 1, std::move(halves.outside))) return false;
      polygon = std::move(halves.inside);
      if (polygon.empty()) return true;
    }
    return true;
  }

  std::span<const ConvexBody> parts_;
  double tolerance_;
  std::size_t last_ = 0;
};

}  // namespace

bool cover(std::span<const ConvexBody> parts, const TriangleMesh& mesh) {
  if (parts.empty()) return false;
  double largest = 0.0;
  for (const Vec3& vertex : mesh.vertices)
    largest = std::max(largest, vertex.cwiseAbs().maxCoeff());
  Cover cover(parts, kRounding * largest);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!cover.holds(mesh.triangle(i))) return false;
  }
  return true;
}

}  // namespace clearance
