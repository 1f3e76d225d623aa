// An ellipsoid around the origin of its frame, along the frame's axes: one smooth part, no planar
// face. h(m) = |D m| with D = diag(semi-axes).
#pragma once

#include <algorithm>

#include "core/model/smooth_part.hpp"

namespace clearance {

class Ellipsoid : public BodyDefaults {
 public:
  explicit Ellipsoid(const CurvedShape& shape) noexcept : d_(shape.semi_axes) {}

  // ---- support ----
  [[nodiscard]] RoundParts round_parts() const noexcept {
    return {d_.data(), &kWhole, 1, kHasCaps};
  }
  [[nodiscard]] std::int32_t parts() const noexcept { return 1; }
  [[nodiscard]] double support_value(const Vec3& m) const noexcept {
    return d_.cwiseProduct(m).norm();
  }
  [[nodiscard]] std::int32_t support_part(const Vec3&) const noexcept { return 0; }
  [[nodiscard]] Vec3 support_point(std::int32_t, const Vec3& m) const noexcept {
    return clearance::support_point(SemiAxes(d_.data()), kWhole, scaled(m));
  }
  [[nodiscard]] PlaneMatrix support_hessian(std::int32_t, const Vec3& m,
                                            const Tangents& tangents) const noexcept {
    return clearance::support_hessian(SemiAxes(d_.data()), kWhole, scaled(m), tangents);
  }
  [[nodiscard]] double relative_slope(const Vec3& m) const noexcept {
    return d_.maxCoeff() / d_.cwiseProduct(m).norm();
  }
  [[nodiscard]] PointOfPart support_set_point(const Vec3& m, const Vec3&, double) const noexcept {
    return {support_point(0, m), 0};
  }
  [[nodiscard]] Vec3 pulled_inside(const Vec3& point) const noexcept {
    const double level = point.cwiseQuotient(d_).norm();
    return level > 1.0 ? Vec3(point / level) : point;
  }

  // ---- extent ----
  [[nodiscard]] double farthest_from(const Vec3& position) const noexcept {
    const double around = position.norm() + d_.maxCoeff();
    return std::min(around, (position.cwiseAbs() + d_).norm());
  }
  [[nodiscard]] Vec3 middle() const noexcept { return Vec3::Zero(); }
  // Both ends of the z-axis, and circles of latitude between them.
  [[nodiscard]] std::vector<Vec3> surface_points(int round) const {
    std::vector<Vec3> points;
    const int latitudes = std::max(2, round / 2);
    for (int k = 0; k <= latitudes; ++k) {
      const double angle = std::numbers::pi * k / latitudes;
      const int steps = k == 0 || k == latitudes ? 1 : round;
      for (int i = 0; i < steps; ++i) {
        const Vec2 to = std::sin(angle) * on_circle(i, steps);
        points.push_back(d_.cwiseProduct(Vec3(to.x(), to.y(), std::cos(angle))));
      }
    }
    return points;
  }

  // ---- symmetry ----
  [[nodiscard]] Ball inscribed_ball() const noexcept { return {Vec3::Zero(), d_.minCoeff()}; }
  // The least radius of curvature.
  [[nodiscard]] double rolling_ball() const noexcept {
    return d_.minCoeff() * (d_.minCoeff() / d_.maxCoeff());
  }
  [[nodiscard]] const Vec3* semi_axes() const noexcept { return &d_; }
  [[nodiscard]] int axis_of_revolution() const noexcept {
    if (d_.x() == d_.y()) return d_.y() == d_.z() ? kAnyAxis : 2;
    if (d_.y() == d_.z()) return 0;
    return d_.x() == d_.z() ? 1 : kNoAxis;
  }
  [[nodiscard]] Vec2 section_support(const Vec2& n) const noexcept {
    const int along = axis_of_revolution() % kAnyAxis;
    const Vec2 section(d_[along], d_[(along + 1) % 3]), scaled = section.cwiseProduct(n);
    return section.cwiseProduct(scaled) / scaled.norm();
  }

 private:
  static constexpr Disc kWhole{0.0, 1.0};

  [[nodiscard]] ScaledDirection scaled(const Vec3& m) const noexcept {
    const Vec3 v = d_.cwiseProduct(m);
    const double length = v.norm();
    return {v / length, length};
  }

  const Vec3& d_;  // semi-axes, m
};

}  // namespace clearance
