// How deep are all corners of a small body below the facets of another? Many facets at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/convex_polyhedron.hpp"

namespace clearance {

// For each facet n.x <= d of a body the greatest d - n.x (m) over the corners of another, and whose
// it is.
class DeepestCorners {
 public:
  static constexpr std::size_t kMostCorners = 24;
  // Of a body with no more edges than one of so many corners can have (66).
  static constexpr std::size_t kMostFacets = 44;

  [[nodiscard]] static bool fit(const std::vector<Vec3>& corners) noexcept {
    return corners.size() <= kMostCorners;
  }

  // `placed` gives the corners in the body's frame. Not more than fit.
  template <class Placed>
  DeepestCorners(const ConvexPolyhedron& body, const std::vector<Vec3>& corners,
                 const Placed& placed) noexcept
      : body_(body), count_(corners.size()) {
    for (std::size_t k = 0; k < count_; ++k) points_[k] = placed(corners[k]);
    find_deepest();
  }

  // Over all facets, and the first facet where that is.
  [[nodiscard]] double least() const noexcept { return least_; }
  [[nodiscard]] std::int32_t where_least() const noexcept { return where_least_; }

  // What follows is for bodies of no more than kMostFacets.

  // The deepest corner below a facet, and its number.
  [[nodiscard]] const Vec3& deepest(std::int32_t facet) const noexcept {
    return points_[number(facet)];
  }
  [[nodiscard]] std::size_t number(std::int32_t facet) const noexcept {
    return static_cast<std::size_t>(whose_[static_cast<std::size_t>(facet)]);
  }

  // Marks which corners are so deep (m) below which facets, and lists those that corner `main` is
  // not.
  [[nodiscard]] std::span<const std::int32_t> mark(double enough, std::size_t main) noexcept;
  // As last marked: is that one? Is any of them, below both?
  [[nodiscard]] bool main_is(std::int32_t facet) const noexcept {
    return (marks_[static_cast<std::size_t>(facet)] & main_) != 0;
  }
  [[nodiscard]] bool one_is(std::int32_t facet, std::int32_t other) const noexcept {
    return (marks_[static_cast<std::size_t>(facet)] & marks_[static_cast<std::size_t>(other)]) != 0;
  }

 private:
  void find_deepest() noexcept;

  // Vectors of up to four run over the end.
  static constexpr std::size_t kRow = kMostFacets + 4;

  const ConvexPolyhedron& body_;
  std::array<double, kRow> depths_, whose_;  // [facet]
  std::array<std::uint64_t, kRow> marks_;    // [facet]: a bit a corner
  std::array<std::int32_t, kRow> list_;
  std::array<Vec3, kMostCorners> points_;
  std::size_t count_;
  std::uint64_t main_ = 0;
  double least_ = kInfinity;
  std::int32_t where_least_ = 0;
};

}  // namespace clearance
