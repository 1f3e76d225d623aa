#include "core/curved/piece.hpp"

#include <algorithm>
#include <cmath>

#include "core/model/support_function.hpp"

namespace clearance {
namespace {

// Below this, a direction is the axis of a truncated cone, and which way it leans is noise. What
// the support point of a disc then falls short is in CurvedPair::error().
constexpr double kOnAxis = 0x1p-51;

// Squares of lengths and of directions neither over- nor underflow: kLeastExtent, kOnAxis.
double length_across(const Vec3& v) noexcept { return std::sqrt(v.x() * v.x() + v.y() * v.y()); }

double disc_value(const Disc& disc, const Vec3& m, double across) noexcept {
  return disc.height * m.z() + disc.radius * across;
}

Vec3 pulled_into_cone(const CurvedBody& body, Vec3 point) noexcept {
  const Disc &low = body.discs[0], &high = body.discs[1];
  point.z() = std::clamp(point.z(), low.height, high.height);
  const double part = (point.z() - low.height) / (high.height - low.height);
  const double limit = (1.0 - part) * low.radius + part * high.radius;
  const double across = length_across(point);
  if (across > limit) point.head<2>() *= limit / across;
  return point;
}

}  // namespace

Azimuth azimuth_of(const PieceSource& source, const Vec3& m) noexcept {
  const double across = length_across(m);
  if (!(across > kOnAxis)) return {kOnAxis, source.rim_azimuth};
  return {across, Vec2(m.x() / across, m.y() / across)};
}

std::int32_t farthest_piece(const PieceSource& source, const Vec3& m) noexcept {
  const CurvedBody& body = *source.body;
  switch (body.kind) {
    case CurvedBody::Kind::kPolyhedron:
      return support(*body.polyhedron, m).anchor;
    case CurvedBody::Kind::kEllipsoid:
      return 0;
    case CurvedBody::Kind::kTruncatedCone:
      break;
  }
  const double across = azimuth_of(source, m).across;
  return disc_value(body.discs[1], m, across) > disc_value(body.discs[0], m, across) ? 1 : 0;
}

Vec3 support_point(const PieceSource& source, std::int32_t piece, const Vec3& m) noexcept {
  const CurvedBody& body = *source.body;
  const auto at = static_cast<std::size_t>(piece);
  switch (body.kind) {
    case CurvedBody::Kind::kPolyhedron:
      return body.polyhedron->anchors[at];
    case CurvedBody::Kind::kEllipsoid: {
      const Vec3 scaled = body.semi_axes.cwiseProduct(m);
      return body.semi_axes.cwiseProduct(scaled) / scaled.norm();
    }
    case CurvedBody::Kind::kTruncatedCone:
      break;
  }
  const Disc& disc = body.discs[at];
  const Vec2 to = azimuth_of(source, m).to;
  return {disc.radius * to.x(), disc.radius * to.y(), disc.height};
}

PlaneMatrix radii_of_curvature(const PieceSource& source, std::int32_t piece, const Vec3& m,
                               const Tangents& tangents) noexcept {
  const CurvedBody& body = *source.body;
  switch (body.kind) {
    case CurvedBody::Kind::kPolyhedron:
      return {};
    case CurvedBody::Kind::kEllipsoid: {
      // D (1 - u u^T) D / |D m| with u along D m, D the semi-axes: by cross products, which keep
      // the digits where one semi-axis is much shorter than the others.
      const Vec3 scaled = body.semi_axes.cwiseProduct(m);
      const double length = scaled.norm();
      const Vec3 u = scaled / length;
      const Vec3 x = u.cross(body.semi_axes.cwiseProduct(tangents.x));
      const Vec3 y = u.cross(body.semi_axes.cwiseProduct(tangents.y));
      return {x.dot(x) / length, x.dot(y) / length, y.dot(y) / length};
    }
    case CurvedBody::Kind::kTruncatedCone:
      break;
  }
  // Along the rim only: the circle is turned by the azimuth, which turns by 1 / across.
  const Azimuth azimuth = azimuth_of(source, m);
  const double along = body.discs[static_cast<std::size_t>(piece)].radius / azimuth.across;
  const auto share = [&](const Vec3& tangent) {
    return azimuth.to.x() * tangent.y() - azimuth.to.y() * tangent.x();
  };
  const double x = share(tangents.x), y = share(tangents.y);
  return {along * x * x, along * x * y, along * y * y};
}

Vec3 pulled_inside(const CurvedBody& body, const Vec3& point) noexcept {
  switch (body.kind) {
    case CurvedBody::Kind::kPolyhedron:
      return point;  // sums of vertices, weights of sum 1
    case CurvedBody::Kind::kEllipsoid: {
      const double level = point.cwiseQuotient(body.semi_axes).norm();
      return level > 1.0 ? Vec3(point / level) : point;
    }
    case CurvedBody::Kind::kTruncatedCone:
      break;
  }
  return pulled_into_cone(body, point);
}

}  // namespace clearance
