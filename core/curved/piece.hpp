// The pieces of a body that have no flats, and their support functions: a polyhedron's vertices, an
// ellipsoid, a truncated cone's discs. All in the body's own frame.
#pragma once

#include <cstdint>

#include "core/convex_body.hpp"

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

// A body as a query sees it.
struct PieceSource {
  const ConvexBody* body = nullptr;
  double reach = 0.0;  // no point of a piece is farther from the frame's origin, m
  // An unbounded polyhedron's rays count as edges of this length, m: every point that can be
  // closest is in the hull of its anchors and what lies at the far ends from each of them.
  double ray_length = 0.0;
  // Which way along the rim a direction leads that is the body's axis: there every point of the
  // disc is a support point, and this picks one.
  Vec2 rim_azimuth{1.0, 0.0};
};

// `within`: no point that can be closest is farther from the frame's origin, m.
[[nodiscard]] PieceSource source_of(const ConvexBody& body, double within) noexcept;

// A polyhedron has a piece an anchor, and behind these as many for each of its rays.
[[nodiscard]] inline std::int32_t pieces_of(const ConvexBody& body) noexcept {
  if (body.is_curved()) return body.curved.kind == CurvedShape::Kind::kEllipsoid ? 1 : 2;
  const auto anchors = static_cast<std::int32_t>(body.anchors.size());
  return anchors * (static_cast<std::int32_t>(body.rays.size()) + 1);
}

// How much of a direction is across the axis of a truncated cone, and which way (unit).
struct Azimuth {
  double across;
  Vec2 to;
};

// The piece that reaches farthest along m (unit): a vertex, a disc, or 0.
[[nodiscard]] std::int32_t farthest_piece(const PieceSource& source, const Vec3& m) noexcept;

// The support point of one piece.
[[nodiscard]] Vec3 support_point(const PieceSource& source, std::int32_t piece,
                                 const Vec3& m) noexcept;

// A point of the body, but for rounding, near a point that lies near its surface.
[[nodiscard]] Vec3 pulled_inside(const ConvexBody& body, const Vec3& point) noexcept;

}  // namespace clearance
