// The deepest vertices of one body below the facets of another, for bodies of few vertices.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/convex_body.hpp"

namespace clearance {

// For each facet n.x <= d of a body, finds the deepest vertex of another body: the greatest d - n.x
// (m) over its vertices.
class DeepestVertices {
 public:
  static constexpr std::size_t kMostVertices = 24;
  // The edges of a body of so many vertices are no more than this (66).
  static constexpr std::size_t kMostScanned = 44;

  [[nodiscard]] static bool fit(const std::vector<Vec3>& vertices) noexcept {
    return vertices.size() <= kMostVertices;
  }

  // `placed` gives the vertices in the body's frame. Not more than fit.
  template <class Placed>
  DeepestVertices(const ConvexBody& body, const std::vector<Vec3>& vertices,
                  const Placed& placed) noexcept
      : body_(body), count_(vertices.size()) {
    for (std::size_t k = 0; k < count_; ++k) points_[k] = placed(vertices[k]);
    find_deepest();
  }

  // Over all facets, and the first facet where that is.
  [[nodiscard]] double least() const noexcept { return least_; }
  [[nodiscard]] std::int32_t where_least() const noexcept { return where_least_; }

  // The members below are for bodies of no more than kMostScanned.

  // The deepest vertex below a facet, and its number.
  [[nodiscard]] const Vec3& deepest(std::int32_t facet) const noexcept {
    return points_[number(facet)];
  }
  [[nodiscard]] std::size_t number(std::int32_t facet) const noexcept {
    return static_cast<std::size_t>(whose_[static_cast<std::size_t>(facet)]);
  }

  // Marks which vertices are so deep (m) below which facets, and lists those that vertex `main` is
  // not.
  [[nodiscard]] std::span<const std::int32_t> mark(double enough, std::size_t main) noexcept;
  // Is the vertex `main` marked for this facet? Is some vertex marked for both facets?
  [[nodiscard]] bool main_is(std::int32_t facet) const noexcept {
    return (marks_[static_cast<std::size_t>(facet)] & main_) != 0;
  }
  [[nodiscard]] bool one_is(std::int32_t facet, std::int32_t other) const noexcept {
    return (marks_[static_cast<std::size_t>(facet)] & marks_[static_cast<std::size_t>(other)]) != 0;
  }

 private:
  void find_deepest() noexcept;

  // Vectors of up to four run over the end.
  static constexpr std::size_t kRow = kMostScanned + 4;

  const ConvexBody& body_;
  std::array<double, kRow> depths_, whose_;  // [facet]
  std::array<std::uint64_t, kRow> marks_;    // [facet]: a bit a vertex
  std::array<std::int32_t, kRow> list_;
  std::array<Vec3, kMostVertices> points_;
  std::size_t count_;
  std::uint64_t main_ = 0;
  double least_ = kInfinity;
  std::int32_t where_least_ = 0;
};

}  // namespace clearance
