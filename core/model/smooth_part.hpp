// The common definitions for the smooth parts of convex bodies. A body is the hull of its smooth
// parts, and its support function h(m) = max m.x is the greatest of theirs. Everything is in the
// body's frame.
//
// The gradient of a part's h is its support point. The second derivative of h, restricted to the
// tangent plane of m, is its support Hessian. The eigenvalues of the Hessian are the principal
// radii of curvature (R. Schneider, Convex Bodies: The Brunn-Minkowski Theory, 2nd ed. 2014,
// section 2.5).
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/convex_body.hpp"
#include "core/curved_shape.hpp"
#include "core/vec.hpp"

namespace clearance {

// Symmetric, on a plane with two axes of unit length at right angles.
struct PlaneMatrix {
  double xx = 0.0, xy = 0.0, yy = 0.0;

  [[nodiscard]] Vec2 operator*(const Vec2& v) const noexcept {
    return {xx * v.x() + xy * v.y(), xy * v.x() + yy * v.y()};
  }
  PlaneMatrix& add(double factor, const PlaneMatrix& m) noexcept {
    xx += factor * m.xx;
    xy += factor * m.xy;
    yy += factor * m.yy;
    return *this;
  }
};

// Two tangents of unit length, at right angles to each other and to a direction.
struct Tangents {
  Vec3 x, y;
};

// A point of a body's support set, and the smooth part that it belongs to.
struct PointOfPart {
  Vec3 point = Vec3::Zero();
  std::int32_t part = 0;
};

struct Ball {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;  // m
};

// All smooth parts of an ellipsoid or of a truncated cone have the form height e_z + radius D B. B
// is the unit ball and D = diag(semi_axes). A disc has D = diag(1, 1, 0). A single part is D B.
struct RoundParts {
  const double* semi_axes;  // three
  const Disc* parts;
  std::int32_t count;
  bool has_caps;
};

using SemiAxes = Eigen::Map<const Vec3>;

// D m by its length and its direction.
struct ScaledDirection {
  Vec3 unit;
  double length;
};

// h(m) = height m_z + radius |D m|.
[[nodiscard]] inline double support_value(const Disc& part, const Vec3& m, double length) noexcept {
  return part.height * m.z() + part.radius * length;
}
[[nodiscard]] inline Vec3 support_point(const SemiAxes& semi_axes, const Disc& part,
                                        const ScaledDirection& scaled) noexcept {
  const Vec3 on_unit = semi_axes.cwiseProduct(scaled.unit);
  return {part.radius * on_unit.x(), part.radius * on_unit.y(),
          part.height + part.radius * on_unit.z()};
}
// radius D (1 - u u^T) D / |D m| with u along D m. Cross products keep the digits where one
// semi-axis is much shorter than the others: t.D (1 - u u^T) D t = |u x D t|^2.
[[nodiscard]] inline PlaneMatrix support_hessian(const SemiAxes& semi_axes, const Disc& part,
                                                 const ScaledDirection& scaled,
                                                 const Tangents& tangents) noexcept {
  const Vec3 x = scaled.unit.cross(semi_axes.cwiseProduct(tangents.x));
  const Vec3 y = scaled.unit.cross(semi_axes.cwiseProduct(tangents.y));
  const double factor = part.radius / scaled.length;
  return {factor * x.dot(x), factor * x.dot(y), factor * y.dot(y)};
}

[[nodiscard]] inline Vec2 on_circle(int step, int steps) noexcept {
  const double angle = 2.0 * std::numbers::pi * (step + 0.5) / steps;
  return {std::cos(angle), std::sin(angle)};
}

// Defaults that a body's own file may override.
struct BodyDefaults {
  static constexpr bool kHasCaps = false;
  static constexpr int kNoAxis = -1, kAnyAxis = 3;

  [[nodiscard]] RoundParts round_parts() const noexcept { return {nullptr, nullptr, 0, false}; }

  // The radius of a ball that rolls inside the body and touches every point of its surface, m.
  [[nodiscard]] double rolling_ball() const noexcept { return 0.0; }
  // See relative_slope() of core/curved/body_view.hpp. A vertex has D = 0.
  [[nodiscard]] double relative_slope(const Vec3&) const noexcept { return 0.0; }
  // The axis of a solid of revolution, 0 to 2; kAnyAxis: a ball.
  [[nodiscard]] int axis_of_revolution() const noexcept { return kNoAxis; }
  // Along the half-plane that this axis bounds: the first coordinate is along the axis, the second
  // one is the distance from it.
  [[nodiscard]] Vec2 section_support(const Vec2&) const noexcept { return Vec2::Zero(); }
  // The semi-axes of an ellipsoid.
  [[nodiscard]] const Vec3* semi_axes() const noexcept { return nullptr; }
  // The support point moves fastest along a rim when m rotates: in this direction, with this radius
  // of curvature (m).
  struct Rim {
    Vec3 tangent = Vec3::Zero();
    double curvature_radius = 0.0;
  };
  [[nodiscard]] Rim rim(const Vec3&) const noexcept { return {}; }
};

}  // namespace clearance
