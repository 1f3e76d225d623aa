// The depth of points and of a sphere of one body below the facets of another, many facets at a
// time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/convex_body.hpp"

namespace clearance {

// Facets n.x <= d of a body, of no more than kMostFacets.
class DeepestPoints {
 public:
  static constexpr std::size_t kMostFacets = 16384;
  static constexpr std::size_t kMostPoints = 4;

  // A point of the other body, or a sphere inside it. Its depth below a facet is d - n.at + radius.
  struct Point {
    Vec3 at;        // the body's frame
    double radius;  // m
    double margin;  // m: the rounding error of the depth of `at` below a facet
    [[nodiscard]] double below(const Facet& facet) const noexcept {
      return (facet.offset - facet.normal.dot(at)) + radius;
    }
    // A point at least this deep below two facets is `enough` deep below all planes between them.
    // The centre of a sphere must be inside both for certain. Past the edge of a nearly flat body,
    // a centre may be outside both by less than rounding, but along the arc by metres.
    [[nodiscard]] double for_arcs(double enough) const noexcept {
      return std::max(enough, radius + margin);
    }
  };

  explicit DeepestPoints(const ConvexBody& body) noexcept : body_(body) {
    std::fill_n(vertices_.begin(), body.facets.size(), kNoVertex);
  }

  [[nodiscard]] static bool fits(const ConvexBody& body) noexcept {
    return body.facets.size() <= kMostFacets;
  }
  [[nodiscard]] bool room_beside_sphere() const noexcept {
    return count_ + (sphere() == nullptr) < kMostPoints;
  }
  // Only if there is a free slot.
  void add(const Vec3& at) noexcept { points_[count_++] = {at, 0.0, 0.0}; }
  // Once.
  void add_sphere(const Vec3& middle, double radius, double margin) noexcept {
    sphere_ = count_;
    points_[count_++] = {middle, radius, margin};
  }
  [[nodiscard]] const Point* sphere() const noexcept {
    return sphere_ < count_ ? &points_[sphere_] : nullptr;
  }
  [[nodiscard]] std::span<const Point> points() const noexcept { return {points_.data(), count_}; }

  // One more vertex of the other body for one facet only, by its number.
  static constexpr std::uint16_t kNoVertex = 0xffff;
  static_assert(2 * kMostFacets - 4 < kNoVertex, "a body has no more vertices (Euler)");
  [[nodiscard]] std::uint16_t* vertices() noexcept { return vertices_.data(); }
  [[nodiscard]] std::uint16_t vertex(std::int32_t facet) const noexcept {
    return vertices_[static_cast<std::size_t>(facet)];
  }

  // The facets below which no point is so deep (m).
  struct Shallow {
    std::span<const std::uint16_t> facets;  // ascending; valid until the next list
    double rest;                            // m: the least depth below the others
    std::int32_t where_least;               // the first facet of all with the least depth
  };
  [[nodiscard]] Shallow list_shallow(double enough) noexcept;
  // Lists the facets below which the point is not deep enough for arcs as well. is_listed() then
  // answers for them.
  [[nodiscard]] std::span<const std::uint16_t> list_not_below(const Point& point,
                                                              double enough) noexcept;
  // Is one of the points that deep below both facets, and so below all between them?
  [[nodiscard]] bool one_is_below(const Facet& facet, const Facet& other,
                                  double enough) const noexcept {
    return std::any_of(points().begin(), points().end(), [&](const Point& point) {
      const double each = point.for_arcs(enough);
      return point.below(facet) >= each && point.below(other) >= each;
    });
  }
  [[nodiscard]] bool is_listed(std::int32_t facet) const noexcept {
    return listed_[static_cast<std::size_t>(facet)];
  }

 private:
  // Vectors of up to four run over the end.
  static constexpr std::size_t kRow = kMostFacets + 4;

  const ConvexBody& body_;
  std::array<Point, kMostPoints> points_;
  std::size_t count_ = 0, sphere_ = kMostPoints;
  std::array<std::uint16_t, kRow> list_;
  // [facet]; only of those that there are. listed_: from the first list_not_below() on.
  std::array<std::uint16_t, kMostFacets> vertices_;
  std::array<bool, kMostFacets> listed_;
};

}  // namespace clearance
