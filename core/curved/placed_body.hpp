// A body in frame A, as Newton's method needs it: support points and how they move, good to a step
// of the direction but not to the last digit of a bound.
#pragma once

#include <cmath>

#include "core/curved/piece.hpp"

namespace clearance {

struct SymmetricMatrix {
  double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;

  [[nodiscard]] Vec3 operator*(const Vec3& v) const noexcept {
    return {xx * v.x() + xy * v.y() + xz * v.z(), xy * v.x() + yy * v.y() + yz * v.z(),
            xz * v.x() + yz * v.y() + zz * v.z()};
  }
  void add(double factor, const SymmetricMatrix& m) noexcept {
    xx += factor * m.xx;
    xy += factor * m.xy;
    xz += factor * m.xz;
    yy += factor * m.yy;
    yz += factor * m.yz;
    zz += factor * m.zz;
  }
  // factor v v^T.
  void add(double factor, const Vec3& v) noexcept {
    const Vec3 f = factor * v;
    xx += f.x() * v.x();
    xy += f.x() * v.y();
    xz += f.x() * v.z();
    yy += f.y() * v.y();
    yz += f.y() * v.z();
    zz += f.z() * v.z();
  }
  [[nodiscard]] double trace() const noexcept { return xx + yy + zz; }
  // x with (this) x = v, by cofactors.
  [[nodiscard]] Vec3 solve(const Vec3& v) const noexcept {
    const SymmetricMatrix cofactors{yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy,
                                    xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy};
    const double determinant = xx * cofactors.xx + xy * cofactors.xy + xz * cofactors.xz;
    return cofactors * v / determinant;
  }
};

// The pieces of a body differ by where their middle is and by their radius: of a vertex 0, of an
// ellipsoid 1, of a disc its own.
struct PlacedPiece {
  Vec3 middle;
  double radius;
};

// Seen along a direction: a piece's support point is its middle and `out` times its radius, and
// that moves by its radius times `turn` when the direction turns.
struct PlacedView {
  Vec3 out = Vec3::Zero();
  SymmetricMatrix turn;
};

class PlacedBody {
 public:
  // x_a = turn * x + origin of the body's own points x.
  PlacedBody(const ConvexPolyhedron& body, const Mat3& turn, const Vec3& origin) noexcept
      : body_(body), turn_(turn), origin_(origin) {
    const CurvedShape& shape = body.curved;
    if (shape.kind == CurvedShape::Kind::kEllipsoid) {
      for (int i = 0; i < 3; ++i) {
        squares_.add(shape.semi_axes[i] * shape.semi_axes[i], Vec3(turn.col(i)));
      }
    }
  }

  [[nodiscard]] PlacedPiece piece(std::int32_t number) const noexcept {
    const auto at = static_cast<std::size_t>(number);
    switch (body_.curved.kind) {
      case CurvedShape::Kind::kNone:
        return {turn_ * body_.anchors[at % body_.anchors.size()] + origin_, 0.0};
      case CurvedShape::Kind::kEllipsoid:
        return {origin_, 1.0};
      case CurvedShape::Kind::kTruncatedCone:
        break;
    }
    const Disc& disc = body_.curved.discs[at];
    return {origin_ + disc.height * turn_.col(2), disc.radius};
  }

  // n: unit.
  [[nodiscard]] PlacedView view(const Vec3& n) const noexcept {
    PlacedView seen;
    switch (body_.curved.kind) {
      case CurvedShape::Kind::kNone:
        return seen;
      case CurvedShape::Kind::kEllipsoid: {
        const Vec3 squared = squares_ * n;
        const double part = 1.0 / std::sqrt(n.dot(squared));
        seen.out = part * squared;
        seen.turn.add(part, squares_);
        seen.turn.add(-part, seen.out);
        return seen;
      }
      case CurvedShape::Kind::kTruncatedCone:
        break;
    }
    const Vec3 axis = turn_.col(2), across = n - n.dot(axis) * axis;
    const double part = 1.0 / across.norm();
    seen.out = part * across;
    seen.turn.add(part, Vec3(axis.cross(seen.out)));
    return seen;
  }

 private:
  const ConvexPolyhedron& body_;
  const Mat3& turn_;
  const Vec3& origin_;
  SymmetricMatrix squares_;  // of an ellipsoid: that of its semi-axes' squares
};

}  // namespace clearance
