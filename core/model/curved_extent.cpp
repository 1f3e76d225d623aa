#include "core/model/curved_extent.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clearance {
namespace {

double across(const Vec3& v) noexcept { return std::hypot(v.x(), v.y()); }

Vec2 on_circle(int step, int steps) {
  const double angle = 2.0 * std::numbers::pi * (step + 0.5) / steps;
  return {std::cos(angle), std::sin(angle)};
}

void add_rims(const CurvedShape& shape, int round, std::vector<Vec3>& points) {
  for (const Disc& disc : shape.discs) {
    const int steps = disc.radius > 0.0 ? round : 1;
    for (int i = 0; i < steps; ++i) {
      const Vec2 to = disc.radius * on_circle(i, steps);
      points.emplace_back(to.x(), to.y(), disc.height);
    }
  }
}

// Both ends of the z-axis, and circles of latitude between them.
void add_latitudes(const CurvedShape& shape, int round, std::vector<Vec3>& points) {
  const int latitudes = std::max(2, round / 2);
  for (int k = 0; k <= latitudes; ++k) {
    const double angle = std::numbers::pi * k / latitudes;
    const int steps = k == 0 || k == latitudes ? 1 : round;
    for (int i = 0; i < steps; ++i) {
      const Vec2 to = std::sin(angle) * on_circle(i, steps);
      points.push_back(shape.semi_axes.cwiseProduct(Vec3(to.x(), to.y(), std::cos(angle))));
    }
  }
}

}  // namespace

double support_value(const CurvedShape& shape, const Vec3& m) noexcept {
  if (shape.kind == CurvedShape::Kind::kEllipsoid) return shape.semi_axes.cwiseProduct(m).norm();
  const auto of = [&](const Disc& disc) { return disc.height * m.z() + disc.radius * across(m); };
  return std::max(of(shape.discs[0]), of(shape.discs[1]));
}

double farthest_from(const CurvedShape& shape, const Vec3& position) noexcept {
  if (shape.kind == CurvedShape::Kind::kEllipsoid) {
    const double around = position.norm() + shape.semi_axes.maxCoeff();
    return std::min(around, (position.cwiseAbs() + shape.semi_axes).norm());
  }
  const auto of = [&](const Disc& disc) {
    return std::hypot(across(position) + disc.radius, position.z() - disc.height);
  };
  return std::max(of(shape.discs[0]), of(shape.discs[1]));
}

// On the axis where both rims are equally far, unless that is beyond the larger one.
Vec3 middle(const CurvedShape& shape) noexcept {
  if (shape.kind == CurvedShape::Kind::kEllipsoid) return Vec3::Zero();
  const auto& [low, high] = shape.discs;
  const double squares = (high.radius - low.radius) * (high.radius + low.radius);
  const double height = 0.5 * (high.height + low.height + squares / (high.height - low.height));
  return {0.0, 0.0, std::clamp(height, low.height, high.height)};
}

std::vector<Vec3> surface_points(const CurvedShape& shape, int round) {
  std::vector<Vec3> points;
  if (shape.kind == CurvedShape::Kind::kEllipsoid) add_latitudes(shape, round, points);
  if (shape.kind == CurvedShape::Kind::kTruncatedCone) add_rims(shape, round, points);
  return points;
}

}  // namespace clearance
