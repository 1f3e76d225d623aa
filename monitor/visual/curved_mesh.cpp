#include "monitor/visual/curved_mesh.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "core/vec.hpp"
#include "monitor/visual/mesh_builder.hpp"

namespace clearance {
namespace {

constexpr double kHalfTurn = std::numbers::pi;

struct SurfacePoint {
  Vec3 position, normal;
};

// Rows of points from the lowest to the highest, each a full circle around the z-axis.
void add_rows(int rows, const std::function<SurfacePoint(int row, double turn)>& point_of,
              MeshBuilder& builder) {
  const int around = builder.arc_steps(2.0 * kHalfTurn);
  std::vector<std::uint32_t> below;
  for (int row = 0; row < rows; ++row) {
    std::vector<std::uint32_t> points;
    for (int i = 0; i <= around; ++i) {
      const auto [position, normal] = point_of(row, 2.0 * kHalfTurn * (i % around) / around);
      points.push_back(builder.add(position, normal));
    }
    if (!below.empty()) builder.strip(below, points);
    below = std::move(points);
  }
}

// Moves each point of the ellipsoid outwards along its normal.
void add_ellipsoid(const Vec3& semi_axes, double radius, MeshBuilder& builder) {
  const int steps = builder.arc_steps(kHalfTurn);
  add_rows(
      steps + 1,
      [&](int row, double turn) {
        const double latitude = kHalfTurn * (static_cast<double>(row) / steps - 0.5);
        const Vec3 unit(std::cos(latitude) * std::cos(turn), std::cos(latitude) * std::sin(turn),
                        std::sin(latitude));
        const Vec3 normal = unit.cwiseQuotient(semi_axes).normalized();
        return SurfacePoint{unit.cwiseProduct(semi_axes) + radius * normal, normal};
      },
      builder);
}

// A point of the profile in the half-plane through the axis. `direction` is the angle of the
// normal, from -pi / 2 (down) to pi / 2 (up).
struct OutlinePoint {
  double from_axis, height, direction;
};

// Adds points around the edge of a disc, between two directions of the normal. With radius 0 this
// is one point, on the edge itself.
void add_arc(const Disc& disc, double from, double to, double radius, const MeshBuilder& builder,
             std::vector<OutlinePoint>& outline) {
  const int steps = radius > 0.0 ? builder.arc_steps(to - from) : 1;
  for (int i = 0; i <= steps; ++i) {
    const double direction = from + (to - from) * i / steps;
    outline.push_back({disc.radius + radius * std::cos(direction),
                       disc.height + radius * std::sin(direction), direction});
  }
}

std::vector<OutlinePoint> outline_of(const std::array<Disc, 2>& discs, double radius,
                                     const MeshBuilder& builder) {
  const auto& [low, high] = discs;
  const double side = std::atan2(low.radius - high.radius, high.height - low.height);
  std::vector<OutlinePoint> outline{{0.0, low.height - radius, -0.5 * kHalfTurn}};
  add_arc(low, -0.5 * kHalfTurn, side, radius, builder, outline);
  add_arc(high, side, 0.5 * kHalfTurn, radius, builder, outline);
  outline.push_back({0.0, high.height + radius, 0.5 * kHalfTurn});
  return outline;
}

void add_rim(const Disc& disc, MeshBuilder& builder) {
  const int steps = builder.arc_steps(2.0 * kHalfTurn);
  const auto point = [&](int i) {
    const double turn = 2.0 * kHalfTurn * (i % steps) / steps;
    return Vec3(disc.radius * std::cos(turn), disc.radius * std::sin(turn), disc.height);
  };
  for (int i = 0; i < steps; ++i) builder.mesh.edges.push_back({point(i), point(i + 1)});
}

void add_truncated_cone(const std::array<Disc, 2>& discs, double radius, MeshBuilder& builder) {
  const std::vector<OutlinePoint> outline = outline_of(discs, radius, builder);
  add_rows(
      static_cast<int>(outline.size()),
      [&](int row, double turn) {
        const OutlinePoint& at = outline[static_cast<std::size_t>(row)];
        const Vec3 out(std::cos(turn), std::sin(turn), 0.0);
        return SurfacePoint{at.from_axis * out + Vec3(0.0, 0.0, at.height),
                            std::cos(at.direction) * out + Vec3(0.0, 0.0, std::sin(at.direction))};
      },
      builder);
  if (radius > 0.0) return;
  for (const Disc& disc : discs) {
    if (disc.radius > 0.0) add_rim(disc, builder);
  }
}

}  // namespace

BodyMesh curved_mesh(const CurvedShape& shape, double radius, double arc_step) {
  MeshBuilder builder(arc_step);
  if (shape.kind == CurvedShape::Kind::kEllipsoid) {
    add_ellipsoid(shape.semi_axes, radius, builder);
  } else {
    add_truncated_cone(shape.discs, radius, builder);
  }
  return std::move(builder.mesh);
}

}  // namespace clearance
