// The result of the methods of §5.1: the point of an ellipsoid's surface nearest to p, which may be
// outside or inside. The ellipsoid is around the origin, along the axes, in any dimension.
#pragma once

#include <Eigen/Core>

namespace clearance::bench {

template <int N>
using Point = Eigen::Matrix<double, N, 1>;

template <int N>
struct NearestPoint {
  Point<N> point;
  int iterations;
  bool converged;
};

}  // namespace clearance::bench
