// The distance of curved bodies in 50 digits: the truth that core/curved is compared with.
//
// The distance is the greatest value of a concave function over |n| <= 1, with support functions h:
//   g(n) = n.t - h_A(n) - h_B(-n).
// The ellipsoid method maximises it (D. B. Yudin and A. S. Nemirovski, 1976; N. Z. Shor, 1977; with
// deep cuts as in R. G. Bland, D. Goldfarb and M. J. Todd, "The ellipsoid method: a survey", 1981).
// It needs only support points: no other derivatives, no smoothness and no active smooth parts.
//
// The result contains its proof. Every direction bounds the greatest value from below. Let the
// ellipsoid that contains the best direction have centre c and matrix P. Let w be the vector
// between the support points at c. Then g(c) + sqrt(w.P w) is an upper bound.
//
// Doubles are taken as exact, and a quaternion q as the rotation of q / |q|. The oracle shares
// nothing with core/ but the structs of the input.
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

// The hull of `points` if there are any, otherwise an ellipsoid or a truncated cone. A ball of
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

// Invariant: lower <= truth <= upper.
struct RealBounds {
  Real lower, upper;
};

// Bounds the signed distance of the bodies. The bounds differ by at most `tolerance` (m), unless
// the bodies overlap without their radii. In that case `lower` is the lowest double and `upper` is
// minus the sum of the radii. Throws std::logic_error where 50 digits are too few, for example at a
// tolerance of 1e-25 for bodies of 1 m that meet vertex to vertex. A tolerance of 1e-20 has been
// enough for all families.
[[nodiscard]] RealBounds curved_truth(const PlacedCurvedBody& a, const PlacedCurvedBody& b,
                                      double tolerance);

// The lower bound of the signed distance that the direction n proves. n is in the world frame, not
// zero and of any length.
[[nodiscard]] Real apart_along(const PlacedCurvedBody& a, const PlacedCurvedBody& b, const Vec3& n);

}  // namespace clearance::oracle
