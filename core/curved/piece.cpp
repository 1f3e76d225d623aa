#include "core/curved/piece-inl.hpp"

#include <algorithm>
#include <cmath>

#include "core/model/support_function.hpp"

namespace clearance {
namespace {

double disc_value(const Disc& disc, const Vec3& m, double across) noexcept {
  return disc.height * m.z() + disc.radius * across;
}

// What makes of an anchor's piece that of the ray that leads farthest along m.
std::int32_t farthest_ray(const ConvexBody& body, const Vec3& m) noexcept {
  double steepest = 0.0;
  std::size_t found = 0;
  for (std::size_t i = 0; i < body.rays.size(); ++i) {
    const double derivative = m.dot(body.rays[i].direction.normalized());
    if (derivative > steepest) {
      steepest = derivative;
      found = i + 1;
    }
  }
  return static_cast<std::int32_t>(found * body.anchors.size());
}

Vec3 pulled_into_cone(const ConvexBody& body, Vec3 point) noexcept {
  const Disc &low = body.curved.discs[0], &high = body.curved.discs[1];
  point.z() = std::clamp(point.z(), low.height, high.height);
  const double part = (point.z() - low.height) / (high.height - low.height);
  const double limit = (1.0 - part) * low.radius + part * high.radius;
  const double across = length_across(point);
  if (across > limit) point.head<2>() *= limit / across;
  return point;
}

}  // namespace

// Closest points of an unbounded polyhedron are an anchor's mean and a sum of up to three rays, of
// which each has a part of at least RecessionCone::least along one direction.
PieceSource source_of(const ConvexBody& body, double within) noexcept {
  PieceSource source{&body, body.bounding_radius};
  if (body.bounded()) return source;
  constexpr double kNarrowest = 0x1p-20;
  const double least = std::clamp(body.recession_cone.least, kNarrowest, 1.0);
  source.ray_length = 4.0 * (within + body.bounding_radius) / least;
  source.reach = body.bounding_radius + source.ray_length;
  return source;
}

std::int32_t farthest_piece(const PieceSource& source, const Vec3& m) noexcept {
  const ConvexBody& body = *source.body;
  switch (body.curved.kind) {
    case CurvedShape::Kind::kNone:
      return support(body, m).anchor + farthest_ray(body, m);
    case CurvedShape::Kind::kEllipsoid:
      return 0;
    case CurvedShape::Kind::kTruncatedCone:
      break;
  }
  const double across = azimuth_of(source, m).across;
  return disc_value(body.curved.discs[1], m, across) > disc_value(body.curved.discs[0], m, across)
             ? 1
             : 0;
}

Vec3 support_point(const PieceSource& source, std::int32_t piece, const Vec3& m) noexcept {
  return support_point(faced(source, m), piece);
}

Vec3 pulled_inside(const ConvexBody& body, const Vec3& point) noexcept {
  switch (body.curved.kind) {
    case CurvedShape::Kind::kNone:
      return point;  // sums of vertices, weights of sum 1
    case CurvedShape::Kind::kEllipsoid: {
      const double level = point.cwiseQuotient(body.curved.semi_axes).norm();
      return level > 1.0 ? Vec3(point / level) : point;
    }
    case CurvedShape::Kind::kTruncatedCone:
      break;
  }
  return pulled_into_cone(body, point);
}

}  // namespace clearance
