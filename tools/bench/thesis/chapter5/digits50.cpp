#include "tools/bench/thesis/chapter5/digits50.hpp"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <stdexcept>

namespace clearance::bench {
namespace {

using Real = boost::multiprecision::cpp_bin_float_50;
using Point = std::array<Real, 3>;
using Matrix = std::array<Point, 3>;  // rows

const Real kTiny("1e-48"), kNear("1e-4");
// A step of Newton's method that is shorter than this share, of an error that it squares.
const Real kLastStep("1e-40");

Real dot(const Point& u, const Point& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }
Point times(const Matrix& m, const Point& v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }
Point plus(const Point& u, const Real& s, const Point& v) {
  return {u[0] + s * v[0], u[1] + s * v[1], u[2] + s * v[2]};
}
Point exact(const Vec3& v) { return {Real(v.x()), Real(v.y()), Real(v.z())}; }
Vec3 rounded(const Point& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

// The rotation matrix of q / |q|, transposed.
Matrix rotation(const Eigen::Quaterniond& q) {
  const Real w = q.w(), x = q.x(), y = q.y(), z = q.z();
  const Real s = 2 / (w * w + x * x + y * y + z * z);
  return {Point{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
          Point{s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
          Point{s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}};
}

// R diag(axes)^2 R': the support function is sqrt(v.Mv), the support point Mv over that.
Matrix squares(const Vec3& axes, const Matrix& r) {
  Matrix m;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      m[i][k] = 0;
      for (int j = 0; j < 3; ++j) m[i][k] += r[i][j] * r[k][j] * Real(axes[j]) * Real(axes[j]);
    }
  }
  return m;
}

// m x = y, by Cramer's rule.
Point solved(const Matrix& m, const Point& y) {
  const auto cross = [](const Point& u, const Point& v) {
    return Point{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  };
  const Point p = cross(m[1], m[2]), q = cross(m[2], m[0]), r = cross(m[0], m[1]);
  const Real det = dot(m[0], p);
  Point x;
  for (int i = 0; i < 3; ++i) x[i] = (p[i] * y[0] + q[i] * y[1] + r[i] * y[2]) / det;
  return x;
}

struct Problem {
  Matrix a, b;
  Point apart;
};

struct Solution {
  Point on_a, on_b;  // relative to A's centre
  Real distance;
};

Real value(const Problem& problem, const Point& v) {
  return dot(v, v) / 2 + sqrt(dot(v, times(problem.a, v))) + sqrt(dot(v, times(problem.b, v))) -
         dot(v, problem.apart);
}

// Adds the support function's second derivatives; returns its first, the support point.
Point differentiate(const Matrix& m, const Point& v, Matrix& second) {
  const Point image = times(m, v);
  const Real h = sqrt(dot(v, image));
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) second[i][k] += m[i][k] / h - image[i] * image[k] / (h * h * h);
  }
  return {image[0] / h, image[1] / h, image[2] / h};
}

Solution solve(const Problem& problem) {
  constexpr int kMostSteps = 200;
  Point v = problem.apart;
  for (int step = 0; step < kMostSteps; ++step) {
    Matrix second{Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};
    const Point on_a = differentiate(problem.a, v, second);
    const Point from_b = differentiate(problem.b, v, second);
    const Point on_b = plus(problem.apart, -1, from_b);
    const Point descent = plus(plus(on_b, -1, on_a), -1, v);  // minus the gradient
    const Point move = solved(second, descent);
    if (dot(move, move) <= kLastStep * kLastStep * dot(v, v)) {
      const Point between = plus(on_b, -1, on_a);
      return {on_a, on_b, sqrt(dot(between, between))};
    }
    Real fraction = 1;
    const Real before = value(problem, v);
    // Near the end, the gain of a step is its square, which is below the resolution of 50 digits.
    const bool near = dot(move, move) <= kNear * kNear * kNear * kNear * dot(v, v);
    while (!near && value(problem, plus(v, fraction, move)) > before) fraction /= 2;
    v = plus(v, fraction, move);
  }
  throw std::invalid_argument("ellipsoids that touch or overlap have no such closest points");
}

Problem problem_of(const EllipsoidPair& pair) {
  const Matrix one{Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};
  return {squares(pair.axes_a, one), squares(pair.axes_b, one), exact(pair.apart)};
}

}  // namespace

TruePoints true_closest_points(const EllipsoidPair& pair) {
  const Solution s = solve(problem_of(pair));
  return {{rounded(s.on_a), rounded(s.on_b)}, static_cast<double>(s.distance)};
}

double true_distance(const Vec3& axes_a, const Pose& world_from_a, const Vec3& axes_b,
                     const Pose& world_from_b) {
  const Problem problem{squares(axes_a, rotation(world_from_a.orientation)),
                        squares(axes_b, rotation(world_from_b.orientation)),
                        plus(exact(world_from_b.position), -1, exact(world_from_a.position))};
  return static_cast<double>(solve(problem).distance);
}

std::string distance_digits(const EllipsoidPair& pair, int digits) {
  return solve(problem_of(pair)).distance.str(digits);
}

// x_i = a_i^2 p_i / (a_i^2 - a_n^2 + t), where a_n is the least semi-axis (5.1.5). The sum of (x_i
// / a_i)^2 is 1 (5.1.6). The sum falls with t > 0. If it is below 1 even at t = 0, p_n is 0 and x_n
// follows from the other coordinates (D. Eberly, "Distance from a point to an ellipse, an
// ellipsoid", 2013).
TrueNearest true_nearest(const Vec3& axes, const Vec3& p) {
  const Point a = exact(axes), q = exact(p.cwiseAbs());
  const auto thin =
      static_cast<std::size_t>(std::min_element(axes.data(), axes.data() + 3) - axes.data());
  Point shift, lifted;
  for (std::size_t i = 0; i < 3; ++i) {
    shift[i] = (a[i] - a[thin]) * (a[i] + a[thin]);
    lifted[i] = a[i] * q[i];
  }
  const auto ratio = [&](std::size_t i, const Real& t) {
    return lifted[i] == 0 ? Real(0) : Real(lifted[i] / (shift[i] + t));
  };
  const auto sum = [&](const Real& t) {
    Real s = 0;
    for (std::size_t i = 0; i < 3; ++i) s += ratio(i, t) * ratio(i, t);
    return s;
  };
  Real low = lifted[thin], high = sqrt(dot(lifted, lifted));
  Point ratios{};
  if (low == 0 && (sum(0) < 1)) {
    for (std::size_t i = 0; i < 3; ++i) ratios[i] = ratio(i, 0);
    ratios[thin] = sqrt(1 - sum(0));
  } else {
    // Halves the exponent first: the root may be many orders below the upper end. Then Newton's
    // method, which from the left of a root of a convex function never passes it.
    while (high - low > kNear * high) {
      const Real middle =
          low > 0 && high > 4 * low ? Real(sqrt(low * high)) : Real((low + high) / 2);
      (sum(middle) > 1 ? low : high) = middle;
    }
    for (Real step = high - low; low > 0 && step > kTiny * low; low += step) {
      Real slope = 0;
      for (std::size_t i = 0; i < 3; ++i)
        slope += 2 * ratio(i, low) * ratio(i, low) / (shift[i] + low);
      step = (sum(low) - 1) / slope;
    }
    for (std::size_t i = 0; i < 3; ++i) ratios[i] = ratio(i, low);
  }
  Point x;
  Real distance2 = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    x[i] = a[i] * ratios[i];
    distance2 += (x[i] - q[i]) * (x[i] - q[i]);
    if (p[static_cast<Eigen::Index>(i)] < 0.0) x[i] = -x[i];
  }
  return {rounded(x), static_cast<double>(sqrt(distance2))};
}

}  // namespace clearance::bench
