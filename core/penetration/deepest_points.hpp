// How deep do a few points and balls of one body lie below the facets of another, and where is more
// to be asked? Many facets at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/convex_polyhedron.hpp"

namespace clearance {

// Facets n.x <= d of a body, of no more than kMostFacets.
class DeepestPoints {
 public:
  static constexpr std::size_t kMostFacets = 16384;
  static constexpr std::size_t kMostPoints = 4;

  // A point, or the ball around it, all of which belongs to the other body: that reaches d - n.at +
  // radius below a facet.
  struct Point {
    Vec3 at;        // the body's frame
    double radius;  // m
    double margin;  // m: what rounding may hide of how far `at` is inside a facet
    [[nodiscard]] double below(const Facet& facet) const noexcept {
      return (facet.offset - facet.normal.dot(at)) + radius;
    }
    // How deep it must be below two facets that it is `enough` deep below all between them: a
    // ball's middle must be inside both for certain. Beyond the edge of a body all but flat it may
    // be outside both by less than rounding can tell, and along the arc by metres.
    [[nodiscard]] double for_arcs(double enough) const noexcept {
      return std::max(enough, radius + margin);
    }
  };

  explicit DeepestPoints(const ConvexPolyhedron& body) noexcept : body_(body) {
    std::fill_n(corners_.begin(), body.facets.size(), kNoCorner);
  }

  [[nodiscard]] static bool fits(const ConvexPolyhedron& body) noexcept {
    return body.facets.size() <= kMostFacets;
  }
  [[nodiscard]] bool room_beside_ball() const noexcept {
    return count_ + (ball() == nullptr) < kMostPoints;
  }
  // Only where there is room.
  void add(const Vec3& at) noexcept { points_[count_++] = {at, 0.0, 0.0}; }
  // Once.
  void add_ball(const Vec3& middle, double radius, double margin) noexcept {
    ball_ = count_;
    points_[count_++] = {middle, radius, margin};
  }
  [[nodiscard]] const Point* ball() const noexcept {
    return ball_ < count_ ? &points_[ball_] : nullptr;
  }
  [[nodiscard]] std::span<const Point> points() const noexcept { return {points_.data(), count_}; }

  // One more corner of the other body for one facet only, by its number.
  static constexpr std::uint16_t kNoCorner = 0xffff;
  static_assert(2 * kMostFacets - 4 < kNoCorner, "a body has no more corners (Euler)");
  [[nodiscard]] std::uint16_t* corners() noexcept { return corners_.data(); }
  [[nodiscard]] std::uint16_t corner(std::int32_t facet) const noexcept {
    return corners_[static_cast<std::size_t>(facet)];
  }

  // The facets that none of the points is so deep (m) below.
  struct Shallow {
    std::span<const std::uint16_t> facets;  // ascending; valid until the next list
    double rest;                            // m: the least depth below the others
    std::int32_t where_least;               // the first facet of all with the least depth
  };
  [[nodiscard]] Shallow list_shallow(double enough) noexcept;
  // Those that one point is not so deep below that it is so along arcs; for is_listed(), too.
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

  const ConvexPolyhedron& body_;
  std::array<Point, kMostPoints> points_;
  std::size_t count_ = 0, ball_ = kMostPoints;
  std::array<std::uint16_t, kRow> list_;
  // [facet]; only of those that there are. listed_: from the first list_not_below() on.
  std::array<std::uint16_t, kMostFacets> corners_;
  std::array<bool, kMostFacets> listed_;
};

}  // namespace clearance
