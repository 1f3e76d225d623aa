// An oracle for distances of convex bodies: it compares all features, in long double.
//
// Two polyhedra that are apart are nearest between a vertex and a triangle, or between two edges.
// Otherwise the penetration depth is the least overlap along the normals of all faces and the
// products of all pairs of edges (the theorem of separating axes). A ball is a point with a radius.
// Nothing of the product is used.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <utility>
#include <vector>

namespace exact {

using Real = long double;
using Point = Eigen::Matrix<Real, 3, 1>;
constexpr Real kInfinity = std::numeric_limits<Real>::infinity();

struct Body {
  std::vector<Point> vertices;
  std::vector<std::array<std::size_t, 3>> triangles;  // of the whole surface; none: a point
  Real radius = 0;                                    // of the sphere around it
};

inline Body ball(double radius) { return {{Point::Zero()}, {}, radius}; }

inline Body box(const Eigen::Vector3d& size) {
  Body body;
  for (int i = 0; i < 8; ++i) {
    const Point corner((i & 1) != 0 ? 0.5L : -0.5L, (i & 2) != 0 ? 0.5L : -0.5L,
                       (i & 4) != 0 ? 0.5L : -0.5L);
    body.vertices.push_back(corner.cwiseProduct(size.cast<Real>()));
  }
  for (const auto& f : {std::array<std::size_t, 4>{0, 1, 3, 2},
                        {4, 5, 7, 6},
                        {0, 1, 5, 4},
                        {2, 3, 7, 6},
                        {0, 2, 6, 4},
                        {1, 3, 7, 5}}) {
    body.triangles.push_back({f[0], f[1], f[2]});
    body.triangles.push_back({f[0], f[2], f[3]});
  }
  return body;
}

inline Body placed(const Body& body, const Eigen::Isometry3d& place) {
  Body moved = body;
  const auto rotation = place.linear().cast<Real>().eval();
  for (Point& p : moved.vertices) p = rotation * p + place.translation().cast<Real>();
  return moved;
}

inline Body shifted(const Body& body, const Point& by) {
  Body moved = body;
  for (Point& p : moved.vertices) p += by;
  return moved;
}

inline std::vector<std::pair<Point, Point>> edges(const Body& body) {
  std::set<std::pair<std::size_t, std::size_t>> ends;
  for (const auto& t : body.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ends.insert(std::minmax(t[i], t[(i + 1) % 3]));
  }
  std::vector<std::pair<Point, Point>> found;
  for (const auto& [i, j] : ends) found.push_back({body.vertices[i], body.vertices[j]});
  return found;
}

inline Real to_segment(const Point& p, const Point& a, const Point& b) {
  const Point d = b - a;
  const Real s = std::clamp<Real>(d.dot(p - a) / d.squaredNorm(), 0, 1);
  return (a + s * d - p).norm();
}

// To the inside of the triangle; its edges are left to the other features.
inline Real to_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Point n = (b - a).cross(c - a);
  const auto is_inside = [&](const Point& u, const Point& v) {
    return n.dot((v - u).cross(p - u)) >= 0;
  };
  if (!is_inside(a, b) || !is_inside(b, c) || !is_inside(c, a)) return kInfinity;
  return std::abs(n.dot(p - a)) / n.norm();
}

inline Real between_segments(const Point& a, const Point& b, const Point& c, const Point& d) {
  Real least = std::min(
      {to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b)});
  const Point u = b - a, v = d - c, w = a - c, n = u.cross(v);
  if (n.squaredNorm() < 1e-30L * u.squaredNorm() * v.squaredNorm()) return least;
  const Real s = v.cross(w).dot(n) / n.squaredNorm(), t = u.cross(w).dot(n) / n.squaredNorm();
  if (s >= 0 && s <= 1 && t >= 0 && t <= 1) least = std::min(least, std::abs(n.dot(w)) / n.norm());
  return least;
}

inline Real apart(const Body& a, const Body& b) {
  Real least = kInfinity;
  for (const auto* pair : {&a, &b}) {
    const Body& other = pair == &a ? b : a;
    for (const Point& p : pair->vertices) {
      for (const auto& t : other.triangles)
        least = std::min(least, to_triangle(p, other.vertices[t[0]], other.vertices[t[1]],
                                            other.vertices[t[2]]));
      for (const auto& [u, v] : edges(other)) least = std::min(least, to_segment(p, u, v));
      for (const Point& q : other.vertices) least = std::min(least, (p - q).norm());
    }
  }
  for (const auto& [p, q] : edges(a)) {
    for (const auto& [u, v] : edges(b)) least = std::min(least, between_segments(p, q, u, v));
  }
  return least;
}

// The least overlap along any axis; negative: apart along one.
inline Real overlap(const Body& a, const Body& b) {
  std::vector<Point> axes;
  for (const Body* body : {&a, &b}) {
    for (const auto& t : body->triangles) {
      const Point& corner = body->vertices[t[0]];
      axes.push_back((body->vertices[t[1]] - corner).cross(body->vertices[t[2]] - corner));
    }
  }
  for (const auto& [p, q] : edges(a)) {
    for (const auto& [u, v] : edges(b)) axes.push_back((q - p).cross(v - u));
  }
  Real least = kInfinity;
  for (const Point& axis : axes) {
    if (axis.squaredNorm() < 1e-24L) continue;
    const Point n = axis.normalized();
    const auto range = [&](const Body& body) {
      std::pair<Real, Real> found(kInfinity, -kInfinity);
      for (const Point& p : body.vertices)
        found = {std::min(found.first, n.dot(p)), std::max(found.second, n.dot(p))};
      return found;
    };
    const auto [low_a, high_a] = range(a);
    const auto [low_b, high_b] = range(b);
    least = std::min({least, high_a - low_b, high_b - low_a});
  }
  return least;
}

// Positive: apart; negative: minus the penetration depth. At least one is no ball.
inline double distance(const Body& a, const Body& b) {
  const Real inside = overlap(a, b);
  const Real cores = inside > 0 && inside < kInfinity ? -inside : apart(a, b);
  return static_cast<double>(cores - a.radius - b.radius);
}

}  // namespace exact
