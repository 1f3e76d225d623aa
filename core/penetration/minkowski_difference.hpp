// The set of all differences x - y of two bodies' points, in the form that the depth search reads.
//
// Everything is in the frame of one of the two, X. Translating Y by v separates the bodies when v
// is not inside this set. The support value of the set along a unit direction n is the displacement
// of Y along n after which the two only touch.
#pragma once

#include "core/convex_body.hpp"
#include "core/model/support_function.hpp"
#include "core/pose.hpp"

namespace clearance {

// Points of one frame in another: rotation (p - before) + after.
struct Placement {
  Mat3 rotation;
  Vec3 before, after;
  [[nodiscard]] Vec3 operator()(const Vec3& p) const noexcept {
    return rotation * (p - before) + after;
  }
};

class MinkowskiDifference {
 public:
  // X is the body whose edges the search follows. It is the unbounded one, the one without facets
  // (a segment or a point), or else the one with fewer edges.
  MinkowskiDifference(const ConvexBody& a, const ConvexBody& b,
                      const RelativePose& a_from_b) noexcept
      : x_is_b_(prefers_second(a, b)),
        x_(x_is_b_ ? b : a),
        y_(x_is_b_ ? a : b),
        x_from_y_(x_is_b_ ? Mat3(a_from_b.rotation.transpose()) : a_from_b.rotation),
        origin_of_y_(x_is_b_ ? Vec3(-(a_from_b.rotation.transpose() * a_from_b.translation))
                             : a_from_b.translation),
        a_from_b_(a_from_b) {}

  [[nodiscard]] const ConvexBody& x() const noexcept { return x_; }
  [[nodiscard]] const ConvexBody& y() const noexcept { return y_; }
  [[nodiscard]] bool x_is_b() const noexcept { return x_is_b_; }

  [[nodiscard]] Vec3 direction_from_y(const Vec3& v) const noexcept { return x_from_y_ * v; }
  [[nodiscard]] Vec3 direction_to_y(const Vec3& v) const noexcept {
    return x_from_y_.transpose() * v;
  }
  [[nodiscard]] Vec3 point_from_y(const Vec3& p) const noexcept {
    return x_from_y_ * p + origin_of_y_;
  }
  [[nodiscard]] Placement x_from_y() const noexcept {
    return {x_from_y_, Vec3::Zero(), origin_of_y_};
  }
  [[nodiscard]] Placement y_from_x() const noexcept {
    return {x_from_y_.transpose(), origin_of_y_, Vec3::Zero()};
  }
  // Between directions from X towards Y in X's frame and from A towards B in A's.
  [[nodiscard]] Vec3 to_a(const Vec3& n) const noexcept {
    return x_is_b_ ? Vec3(-(a_from_b_.rotation * n)) : n;
  }
  [[nodiscard]] Vec3 from_a(const Vec3& n) const noexcept {
    return x_is_b_ ? Vec3(-(a_from_b_.rotation.transpose() * n)) : n;
  }

  // The support point of Y against n: the index of a vertex in `anchors`, and its position.
  [[nodiscard]] std::int32_t lowest_anchor_of_y(const Vec3& n) const noexcept {
    return support(y_, -direction_to_y(n)).anchor;
  }
  [[nodiscard]] Vec3 support_point_of_y(const Vec3& n) const noexcept {
    return point_from_y(y_.anchors[lowest_anchor_of_y(n)]);
  }
  // The support point of the set along n, where `on_x` is that of X.
  [[nodiscard]] Vec3 support_point(const Vec3& on_x, const Vec3& n) const noexcept {
    return on_x - support_point_of_y(n);
  }
  // The same with a point of Y.
  [[nodiscard]] Vec3 support_point_on_x(const Vec3& on_y, const Vec3& n) const noexcept {
    return x_.anchors[support(x_, n).anchor] - point_from_y(on_y);
  }

 private:
  static bool prefers_second(const ConvexBody& a, const ConvexBody& b) noexcept {
    if (a.bounded() != b.bounded()) return a.bounded();
    if (a.facets.empty() != b.facets.empty()) return b.facets.empty();
    return b.edges.size() < a.edges.size();
  }

  bool x_is_b_;
  const ConvexBody& x_;
  const ConvexBody& y_;
  Mat3 x_from_y_;
  Vec3 origin_of_y_;
  const RelativePose& a_from_b_;
};

}  // namespace clearance
