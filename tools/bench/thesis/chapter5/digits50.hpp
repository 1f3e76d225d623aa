// Truth in 50 decimal digits (boost::multiprecision), by methods that are none of those compared.
#pragma once

#include <string>

#include "core/pose.hpp"
#include "tools/bench/crossed_ellipsoids.hpp"

namespace clearance::bench {

struct TruePoints {
  ClosestPoints points;  // each coordinate rounded once
  double distance;
};

// The closest points of ellipsoids that do not overlap. The vector v from A's closest point to B's
// minimises the convex function |v|^2 / 2 + h_A(v) + h_B(v) - v.apart. Here h are the support
// functions of the bodies around the origin. Newton's method finds it.
[[nodiscard]] TruePoints true_closest_points(const EllipsoidPair& pair);

struct CrossedTest {
  EllipsoidPair pair;
  TruePoints truth;
};
[[nodiscard]] inline CrossedTest crossed_test(double separation) {
  const EllipsoidPair pair = crossed_pair(separation);
  return {pair, true_closest_points(pair)};
}

// The same for ellipsoids at any pose; the rotations are those of the normalised quaternions.
[[nodiscard]] double true_distance(const Vec3& axes_a, const Pose& world_from_a, const Vec3& axes_b,
                                   const Pose& world_from_b);

// The distance in this many digits, as text.
[[nodiscard]] std::string distance_digits(const EllipsoidPair& pair, int digits);

// The point of the surface of an ellipsoid that is nearest to p, which may be anywhere; where there
// are several, one of them.
struct TrueNearest {
  Vec3 point;
  double distance;
};
[[nodiscard]] TrueNearest true_nearest(const Vec3& axes, const Vec3& p);

}  // namespace clearance::bench
