// How far curved bodies are apart, in 50 digits: the truth that core/curved is held against.
//
// The distance is the greatest value over |n| <= 1 of the concave function
//   g(n) = n.t - h_A(n) - h_B(-n),
// h being support functions. The ellipsoid method (D. B. Yudin and A. S. Nemirovski, 1976; N. Z.
// Shor, 1977; with deep cuts as in R. G. Bland, D. Goldfarb and M. J. Todd, "The ellipsoid method:
// a survey", 1981) maximises it. It needs no derivatives but the support points, no smoothness and
// no active pieces, and what it says is its own proof: every direction bounds the greatest value
// from below, and of the ellipsoid that still holds the best direction, with centre c, matrix P and
// support points w apart at c, g(c) + sqrt(w.P w) bounds it from above. Doubles are exact here and
// a quaternion q is the rotation of q / |q|. Shares nothing with core/ but the structs of the
// input.
#pragma once

#include <array>
#include <boost/multiprecision/gmp.hpp>
#include <vector>

#include "core/curved_shape.hpp"
#include "core/pose.hpp"

namespace clearance::oracle {

using Real = boost::multiprecision::number<boost::multiprecision::gmp_float<50>,
                                           boost::multiprecision::et_off>;
using RealVec = std::array<Real, 3>;

// The hull of `points` where there are any; else an ellipsoid or a truncated cone. A ball of
// `radius` is added to either.
struct CurvedBody {
  std::vector<Vec3> points;
  CurvedShape shape;
  double radius = 0.0;
};

struct PlacedCurvedBody {
  const CurvedBody* body = nullptr;
  Pose world_from_body;
};

// lower <= truth <= upper.
struct RealBounds {
  Real lower, upper;
};

// Of the bodies' signed distance. The bounds are within `tolerance` (m) of each other, unless the
// bodies without radii overlap: then `lower` is the lowest double, `upper` minus the radii.
// Throws std::logic_error where 50 digits are too few, as for 1e-25 of bodies that are 1 m large
// and meet vertex to vertex; 1e-20 has been enough for all families.
[[nodiscard]] RealBounds curved_truth(const PlacedCurvedBody& a, const PlacedCurvedBody& b,
                                      double tolerance);

// What the direction n (world, not zero, any length) proves: the signed distance is at least this.
[[nodiscard]] Real apart_along(const PlacedCurvedBody& a, const PlacedCurvedBody& b, const Vec3& n);

}  // namespace clearance::oracle
