#include "tools/scene/fitting/enclosing_circle.hpp"

#include <algorithm>
#include <cmath>

namespace clearance {
namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

bool holds(const Circle& circle, const Vec2& p) {
  return (p - circle.centre).norm() <= circle.radius * (1.0 + 1e-14);
}

Circle around(const Vec2& a, const Vec2& b) { return {0.5 * (a + b), 0.5 * (a - b).norm()}; }

Circle around(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 u = b - a, v = c - a;
  const double twice = 2.0 * cross(u, v);
  if (twice == 0.0) {
    const Circle circles[] = {around(a, b), around(a, c), around(b, c)};
    return *std::max_element(std::begin(circles), std::end(circles),
                             [](const Circle& x, const Circle& y) { return x.radius < y.radius; });
  }
  const Vec2 to_centre((v.y() * u.squaredNorm() - u.y() * v.squaredNorm()) / twice,
                       (u.x() * v.squaredNorm() - v.x() * u.squaredNorm()) / twice);
  return {a + to_centre, to_centre.norm()};
}

}  // namespace

Circle enclosing_circle(std::span<const Vec2> points) {
  Circle circle{points[0], 0.0};
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (holds(circle, points[i])) continue;
    circle = {points[i], 0.0};
    for (std::size_t j = 0; j < i; ++j) {
      if (holds(circle, points[j])) continue;
      circle = around(points[i], points[j]);
      for (std::size_t k = 0; k < j; ++k) {
        if (!holds(circle, points[k])) circle = around(points[i], points[j], points[k]);
      }
    }
  }
  return circle;
}

std::vector<Vec2> convex_polygon(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](const Vec2& p, const Vec2& q) {
    return p.x() < q.x() || (p.x() == q.x() && p.y() < q.y());
  });
  std::vector<Vec2> chain;
  const auto add = [&](const Vec2& p, std::size_t first) {
    while (chain.size() >= first + 2 &&
           cross(chain.back() - chain[chain.size() - 2], p - chain.back()) <= 0.0) {
      chain.pop_back();
    }
    chain.push_back(p);
  };
  for (const Vec2& p : points) add(p, 0);
  const std::size_t upper = chain.size() - 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) add(*p, upper);
  if (chain.size() > 1) chain.pop_back();
  return chain;
}

}  // namespace clearance
