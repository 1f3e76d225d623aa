// The pieces of a body that have no flats, and their support functions: a polyhedron's vertices, an
// ellipsoid, a truncated cone's discs. All in the body's own frame.
#pragma once

#include <cstdint>

#include "core/curved/curved_body.hpp"

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

// A body, and which way along its rim a direction leads that is its axis: there every point of the
// disc is a support point, and this picks one.
struct PieceSource {
  const CurvedBody* body = nullptr;
  Vec2 rim_azimuth{1.0, 0.0};
};

// How much of a direction is across the axis of a truncated cone, and which way (unit).
struct Azimuth {
  double across;
  Vec2 to;
};
[[nodiscard]] Azimuth azimuth_of(const PieceSource& source, const Vec3& m) noexcept;

// The piece that reaches farthest along m (unit): a vertex, a disc, or 0.
[[nodiscard]] std::int32_t farthest_piece(const PieceSource& source, const Vec3& m) noexcept;

// The support point of one piece.
[[nodiscard]] Vec3 support_point(const PieceSource& source, std::int32_t piece,
                                 const Vec3& m) noexcept;

// How that point moves when m turns: the second derivative of the piece's support function on the
// tangents, in m. Positive semidefinite; its eigenvalues are the radii of curvature.
[[nodiscard]] PlaneMatrix radii_of_curvature(const PieceSource& source, std::int32_t piece,
                                             const Vec3& m, const Tangents& tangents) noexcept;

// A point of the body, but for rounding, near a point that lies near its surface.
[[nodiscard]] Vec3 pulled_inside(const CurvedBody& body, const Vec3& point) noexcept;

}  // namespace clearance
