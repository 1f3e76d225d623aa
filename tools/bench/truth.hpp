// The reference distance for the error of every row, from a method that shares nothing with the
// core. It is Wolfe's nearest point (P. Wolfe, "Finding the nearest point in a polytope", 1976)
// over all differences of support points, in 80-bit long doubles. Each answer has the gap between
// its primal and its dual value. Bodies are the hulls of the polyhedra's vertices, or the curved
// shapes; radii are taken off. Poses are the exact rotations of their quaternions.
#pragma once

#include <vector>

#include "core/convex_body.hpp"
#include "core/pose.hpp"

namespace clearance::bench {

struct Truth {
  double distance;  // 0 where the bodies overlap
  double gap;       // m: no farther from the exact distance than this, but for rounding (1e-18)
  // Unit, from A towards B in the world; zero where the bodies overlap. Its angle to the exact
  // normal is at most about sqrt(2 * gap / distance).
  Vec3 normal = Vec3::Zero();
};

class TrueDistance {
 public:
  TrueDistance(const ConvexBody& a, const ConvexBody& b);
  // Starts where the last call ended, which is fast for neighbouring poses.
  [[nodiscard]] Truth at(const Pose& world_from_a, const Pose& world_from_b);

 private:
  using Real = long double;
  using Point = Eigen::Matrix<Real, 3, 1>;
  using Matrix = Eigen::Matrix<Real, 3, 3>;
  // A difference b - a of two points of the bodies, each in its own frame, and its weight in the
  // nearest point.
  struct Corner {
    Point own_a, own_b, point;
    Real weight;
  };

  [[nodiscard]] static Point support(const ConvexBody& body, const Point& along);
  void place(Corner& corner) const;
  [[nodiscard]] Corner support_point(const Point& against) const;
  [[nodiscard]] Point nearest() const;
  void minimise();

  const ConvexBody &a_, &b_;
  Matrix world_from_a_, world_from_b_;
  Point apart_;  // from A's position to B's
  std::vector<Corner> corners_;
};

}  // namespace clearance::bench
