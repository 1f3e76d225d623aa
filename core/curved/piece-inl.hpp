// A body seen along a direction: what its pieces have in common there, computed once.
#pragma once

#include <cmath>

#include "core/curved/piece.hpp"

namespace clearance {

// Below this, a direction is the axis of a truncated cone, and which way it leans is noise. What
// the support point of a disc then falls short is in CurvedPair::error().
inline constexpr double kOnAxis = 0x1p-51;

// Squares of lengths and of directions neither over- nor underflow: kLeastExtent, kOnAxis.
[[nodiscard]] inline double length_across(const Vec3& v) noexcept {
  return std::sqrt(v.x() * v.x() + v.y() * v.y());
}

[[nodiscard]] inline Azimuth azimuth_of(const PieceSource& source, const Vec3& m) noexcept {
  const double across = length_across(m);
  if (!(across > kOnAxis)) return {kOnAxis, source.rim_azimuth};
  return {across, Vec2(m.x() / across, m.y() / across)};
}

// m: unit, in the body's frame.
struct FacedBody {
  const PieceSource& source;
  Vec3 m;
  Azimuth azimuth;  // of a truncated cone
  Vec3 scaled;      // of an ellipsoid: its semi-axes times m,
  double length;    // and the length of that: how far it reaches
};

[[nodiscard]] inline FacedBody faced(const PieceSource& source, const Vec3& m) noexcept {
  FacedBody found{source, m, {0.0, Vec2::Zero()}, Vec3::Zero(), 0.0};
  const CurvedShape& shape = source.body->curved;
  if (shape.kind == CurvedShape::Kind::kTruncatedCone) found.azimuth = azimuth_of(source, m);
  if (shape.kind == CurvedShape::Kind::kEllipsoid) {
    found.scaled = shape.semi_axes.cwiseProduct(m);
    found.length = found.scaled.norm();
  }
  return found;
}

// A polyhedron's piece: an anchor, or what lies at the end of one of its rays from there.
[[nodiscard]] inline Vec3 anchor_or_far_end(const PieceSource& source, std::size_t piece) noexcept {
  const ConvexBody& body = *source.body;
  if (body.bounded()) return body.anchors[piece];
  const Vec3& anchor = body.anchors[piece % body.anchors.size()];
  const std::size_t ray = piece / body.anchors.size();
  if (ray == 0) return anchor;
  return anchor + source.ray_length * body.rays[ray - 1].direction.normalized();
}

[[nodiscard]] inline Vec3 support_point(const FacedBody& faced, std::int32_t piece) noexcept {
  const ConvexBody& body = *faced.source.body;
  const auto at = static_cast<std::size_t>(piece);
  switch (body.curved.kind) {
    case CurvedShape::Kind::kNone:
      return anchor_or_far_end(faced.source, at);
    case CurvedShape::Kind::kEllipsoid:
      return body.curved.semi_axes.cwiseProduct(faced.scaled) / faced.length;
    case CurvedShape::Kind::kTruncatedCone:
      break;
  }
  const Disc& disc = body.curved.discs[at];
  const Vec2& to = faced.azimuth.to;
  return {disc.radius * to.x(), disc.radius * to.y(), disc.height};
}

// How the support point moves when m turns: the second derivative of the piece's support function
// on the tangents, in m. Positive semidefinite; its eigenvalues are the radii of curvature.
[[nodiscard]] inline PlaneMatrix radii_of_curvature(const FacedBody& faced, std::int32_t piece,
                                                    const Tangents& tangents) noexcept {
  const CurvedShape& shape = faced.source.body->curved;
  switch (shape.kind) {
    case CurvedShape::Kind::kNone:
      return {};
    case CurvedShape::Kind::kEllipsoid: {
      // D (1 - u u^T) D / |D m| with u along D m, D the semi-axes: by cross products, which keep
      // the digits where one semi-axis is much shorter than the others.
      const Vec3 u = faced.scaled / faced.length;
      const Vec3 x = u.cross(shape.semi_axes.cwiseProduct(tangents.x));
      const Vec3 y = u.cross(shape.semi_axes.cwiseProduct(tangents.y));
      const double part = 1.0 / faced.length;
      return {x.dot(x) * part, x.dot(y) * part, y.dot(y) * part};
    }
    case CurvedShape::Kind::kTruncatedCone:
      break;
  }
  // Along the rim only: the circle is turned by the azimuth, which turns by 1 / across.
  const auto& [across, to] = faced.azimuth;
  const double along = shape.discs[static_cast<std::size_t>(piece)].radius / across;
  const double x = to.x() * tangents.x.y() - to.y() * tangents.x.x();
  const double y = to.x() * tangents.y.y() - to.y() * tangents.y.x();
  return {along * x * x, along * x * y, along * y * y};
}

}  // namespace clearance
