// A truncated cone around the z-axis; cylinders and cones are special cases. It is the hull of two
// discs, which are its smooth parts, with a planar face (cap) at each end.
//
// h(m) = max over both discs of height m_z + radius |(m_x, m_y)|. Along the axis a whole disc is
// the support set; there the rim point in the direction of `rim_azimuth` stands for it.
#pragma once

#include <algorithm>
#include <array>

#include "core/model/smooth_part.hpp"

namespace clearance {

class TruncatedCone : public BodyDefaults {
 public:
  static constexpr bool kHasCaps = true;
  // Below this sine, a direction counts as the axis, and the side to which it leans is noise. The
  // support value that a disc's support point then misses is part of the rounding error
  // (bounds.hpp).
  static constexpr double kOnAxis = 0x1p-51;

  explicit TruncatedCone(const CurvedShape& shape, const Vec2& rim_azimuth = {1.0, 0.0}) noexcept
      : discs_(shape.discs), rim_azimuth_(rim_azimuth) {}

  // ---- support ----
  [[nodiscard]] RoundParts round_parts() const noexcept {
    return {kUnitDisc, discs_.data(), 2, kHasCaps};
  }
  [[nodiscard]] std::int32_t parts() const noexcept { return 2; }
  [[nodiscard]] double support_value(const Vec3& m) const noexcept {
    const double across = across_axis(m);
    return std::max(clearance::support_value(discs_[0], m, across),
                    clearance::support_value(discs_[1], m, across));
  }
  [[nodiscard]] std::int32_t support_part(const Vec3& m) const noexcept {
    const double across = scaled(m).length;
    return clearance::support_value(discs_[1], m, across) >
                   clearance::support_value(discs_[0], m, across)
               ? 1
               : 0;
  }
  [[nodiscard]] Vec3 support_point(std::int32_t part, const Vec3& m) const noexcept {
    return clearance::support_point(SemiAxes(kUnitDisc), disc(part), scaled(m));
  }
  [[nodiscard]] PlaneMatrix support_hessian(std::int32_t part, const Vec3& m,
                                            const Tangents& tangents) const noexcept {
    return clearance::support_hessian(SemiAxes(kUnitDisc), disc(part), scaled(m), tangents);
  }
  [[nodiscard]] double relative_slope(const Vec3& m) const noexcept {
    return 1.0 / scaled(m).length;
  }
  // The support set along m is a disc if m is the axis. It is a generator if both rims have the
  // same support value, and one point of a rim otherwise.
  [[nodiscard]] PointOfPart support_set_point(const Vec3& m, const Vec3& towards,
                                              double tolerance) const noexcept {
    constexpr double kParallel = 0x1p-50;
    if (scaled(m).length <= kParallel) {
      const std::int32_t part = m.z() > 0.0 ? 1 : 0;
      const Vec2 to = Vec2(towards.x(), towards.y()).normalized();
      return {Vec3(disc(part).radius * to.x(), disc(part).radius * to.y(), disc(part).height),
              part};
    }
    const Vec3 low = support_point(0, m), high = support_point(1, m);
    const double at_low = m.dot(low), at_high = m.dot(high);
    const bool level = std::abs(at_high - at_low) <= tolerance;
    const bool is_high = level ? towards.dot(high) > towards.dot(low) : at_high > at_low;
    return is_high ? PointOfPart{high, 1} : PointOfPart{low, 0};
  }
  // Clamped to the height, and then scaled towards the axis.
  [[nodiscard]] Vec3 pulled_inside(Vec3 point) const noexcept {
    const auto& [low, high] = discs_;
    point.z() = std::clamp(point.z(), low.height, high.height);
    const double part = (point.z() - low.height) / (high.height - low.height);
    const double limit = (1.0 - part) * low.radius + part * high.radius;
    const double across = across_axis(point);
    if (across > limit) point.head<2>() *= limit / across;
    return point;
  }
  [[nodiscard]] Rim rim(const Vec3& m) const noexcept {
    const auto [unit, across] = scaled(m);
    return {Vec3(-unit.y(), unit.x(), 0.0), std::max(discs_[0].radius, discs_[1].radius) / across};
  }

  // ---- extent ----
  [[nodiscard]] double farthest_from(const Vec3& position) const noexcept {
    const auto to = [&](const Disc& disc) {
      return std::hypot(std::hypot(position.x(), position.y()) + disc.radius,
                        position.z() - disc.height);
    };
    return std::max(to(discs_[0]), to(discs_[1]));
  }
  // The point of the axis that is equally far from both rims, unless that lies past the larger one.
  [[nodiscard]] Vec3 middle() const noexcept {
    const auto& [low, high] = discs_;
    const double squares = (high.radius - low.radius) * (high.radius + low.radius);
    const double height = 0.5 * (high.height + low.height + squares / (high.height - low.height));
    return {0.0, 0.0, std::clamp(height, low.height, high.height)};
  }
  [[nodiscard]] std::vector<Vec3> surface_points(int round) const {
    std::vector<Vec3> points;
    for (const Disc& disc : discs_) {
      const int steps = disc.radius > 0.0 ? round : 1;
      for (int i = 0; i < steps; ++i) {
        const Vec2 to = disc.radius * on_circle(i, steps);
        points.emplace_back(to.x(), to.y(), disc.height);
      }
    }
    return points;
  }

  // ---- symmetry ----
  [[nodiscard]] Ball inscribed_ball() const noexcept {
    const auto& [low, high] = discs_;
    if (low.radius != high.radius) return {};
    return {Vec3(0.0, 0.0, 0.5 * (low.height + high.height)),
            std::min(low.radius, 0.5 * (high.height - low.height))};
  }
  [[nodiscard]] int axis_of_revolution() const noexcept { return 2; }
  [[nodiscard]] Vec2 section_support(const Vec2& n) const noexcept {
    const Vec2 low(discs_[0].height, discs_[0].radius), high(discs_[1].height, discs_[1].radius);
    return n.dot(high) > n.dot(low) ? high : low;
  }

 private:
  static constexpr double kUnitDisc[3] = {1.0, 1.0, 0.0};

  [[nodiscard]] const Disc& disc(std::int32_t part) const noexcept {
    return discs_[static_cast<std::size_t>(part)];
  }
  // Squares neither over- nor underflow: kLeastExtent, kOnAxis.
  [[nodiscard]] static double across_axis(const Vec3& v) noexcept {
    return std::sqrt(v.x() * v.x() + v.y() * v.y());
  }
  [[nodiscard]] ScaledDirection scaled(const Vec3& m) const noexcept {
    const double across = across_axis(m);
    if (!(across > kOnAxis)) return {Vec3(rim_azimuth_.x(), rim_azimuth_.y(), 0.0), kOnAxis};
    return {Vec3(m.x() / across, m.y() / across, 0.0), across};
  }

  const std::array<Disc, 2>& discs_;
  Vec2 rim_azimuth_;  // unit
};

}  // namespace clearance
