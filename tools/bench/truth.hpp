// The reference distance for the error of every row, from a method that shares nothing with
// the core: Wolfe's nearest point (P. Wolfe, "Finding the nearest point in a polytope", 1976) over
// all differences of vertices, in 80-bit long doubles, each answer with the gap between its primal
// and its dual value. Bodies are the hulls of the polyhedra's vertices; poses are the exact
// rotations of their quaternions.
#pragma once

#include <vector>

#include "core/convex_polyhedron.hpp"
#include "core/pose.hpp"

namespace clearance::bench {

struct Truth {
  double distance;  // 0 where the bodies overlap
  double gap;       // m: no farther from the exact distance than this, but for rounding (1e-18)
};

class TrueDistance {
 public:
  TrueDistance(const ConvexPolyhedron& a, const ConvexPolyhedron& b);
  // Starts where the last call ended, which is fast for neighbouring poses.
  [[nodiscard]] Truth at(const Pose& world_from_a, const Pose& world_from_b);

 private:
  using Real = long double;
  using Point = Eigen::Matrix<Real, 3, 1>;
  using Points = Eigen::Matrix<Real, 3, Eigen::Dynamic>;
  // A difference b - a of two vertices, and its weight in the nearest point.
  struct Corner {
    int a, b;
    Point point;
    Real weight;
  };

  [[nodiscard]] Corner farthest(const Point& against) const;
  [[nodiscard]] Point nearest() const;
  void minimise();

  Points own_a_, own_b_;
  Points a_, b_;  // in the world, relative to A's position
  std::vector<Corner> corners_;
};

}  // namespace clearance::bench
