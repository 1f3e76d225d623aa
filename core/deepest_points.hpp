// How deep are a few points below all facets of a body? Many facets at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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

  // All of another body's corners at once, as the first points: `placed` gives them in this one's
  // frame. Their labels are 0, 1, ... Not more than fit.
  [[nodiscard]] static bool fit(const std::vector<Vec3>& corners) noexcept {
    return corners.size() <= kMostPoints;
  }
  template <class Placed>
  void add_all(const std::vector<Vec3>& corners, const Placed& placed) noexcept {
    for (std::size_t k = 0; k < corners.size(); ++k) points_[k] = placed(corners[k]);
    take(corners.size());
  }
  [[nodiscard]] bool has_all() const noexcept { return has_all_; }
  // In the body's frame. Not when full. label: any number to know it by.
  void add(const Vec3& point, std::int32_t label) noexcept;

  // Over all facets; of no points, -infinity.
  [[nodiscard]] double least() const noexcept { return least_; }
  // The first facet where that is.
  [[nodiscard]] std::int32_t where_least() const noexcept;
  [[nodiscard]] double depth(std::int32_t facet) const noexcept { return depths_[facet]; }
  [[nodiscard]] std::int32_t label(std::int32_t facet) const noexcept {
    return static_cast<std::int32_t>(whose_[facet]);
  }
  [[nodiscard]] const Vec3& point(std::size_t number) const noexcept { return points_[number]; }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }

  // One more point for one facet only. least() knows nothing of it.
  void know(std::int32_t facet, const Vec3& point, std::int32_t label) noexcept {
    const Facet& f = body_.facets[facet];
    const double depth = f.offset - f.normal.dot(point);
    if (!(depth > depths_[facet])) return;
    depths_[facet] = depth;
    whose_[facet] = label;
  }
  // The facets that no point is so deep (m) below. least: the depth below the others. Valid until
  // the next list.
  [[nodiscard]] std::span<const std::int32_t> list_shallower(double enough, double& least) noexcept;

  // Marks which of the points that were added are so deep (m) below which facets, and lists those
  // that point number `main` is not.
  [[nodiscard]] std::span<const std::int32_t> mark(double enough, std::size_t main) noexcept;
  // As last marked: is that one? Is any of them, below both?
  [[nodiscard]] bool main_is(std::int32_t facet) const noexcept {
    return (marks_[facet] & main_) != 0;
  }
  [[nodiscard]] bool one_is(std::int32_t facet, std::int32_t other) const noexcept {
    return (marks_[facet] & marks_[other]) != 0;
  }

 private:
  void clear() noexcept;
  // The first points_ are there.
  void take(std::size_t points) noexcept;

  // Vectors of up to four run over the end.
  static constexpr std::size_t kRow = kMostFacets + 4;

  const ConvexPolyhedron& body_;
  std::array<double, kRow> depths_, whose_;  // [facet]
  std::array<std::uint64_t, kRow> marks_;    // [facet]: a bit a point
  std::array<std::int32_t, kRow> list_;
  std::array<Vec3, kMostPoints> points_;
  std::size_t count_ = 0;
  std::uint64_t main_ = 0;
  bool has_all_ = false;
  double least_ = -kInfinity;
};

}  // namespace clearance
