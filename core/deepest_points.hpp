// How deep are a few points below all facets of a body? Many facets at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/convex_polyhedron.hpp"

namespace clearance {

// Of points x that have been added, for each facet n.x <= d the greatest d - n.x (m) and whose it
// is. Bodies of no more than kMostFacets.
class DeepestPoints {
 public:
  static constexpr std::size_t kMostFacets = 2048;
  static constexpr std::size_t kMostPoints = 24;

  explicit DeepestPoints(const ConvexPolyhedron& body) noexcept : body_(body) {}

  [[nodiscard]] static bool fits(const ConvexPolyhedron& body) noexcept {
    return body.facets.size() <= kMostFacets;
  }
  [[nodiscard]] bool full() const noexcept { return count_ == kMostPoints; }

  // In the body's frame. Not when full.
  void add(const Vec3& point) noexcept;

  // Over all facets; of no points, -infinity.
  [[nodiscard]] double least() const noexcept { return least_; }
  // The first facet where that is.
  [[nodiscard]] std::int32_t where_least() const noexcept;
  [[nodiscard]] double depth(std::int32_t facet) const noexcept { return depths_[facet]; }
  [[nodiscard]] const Vec3& point(std::int32_t facet) const noexcept {
    return points_[static_cast<std::size_t>(which_[facet])];
  }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }

 private:
  // Vectors of up to four run over the end.
  using Row = std::array<double, kMostFacets + 4>;

  const ConvexPolyhedron& body_;
  Row depths_, which_;  // [facet]
  std::array<Vec3, kMostPoints> points_;
  std::size_t count_ = 0;
  double least_ = -kInfinity;
};

}  // namespace clearance
