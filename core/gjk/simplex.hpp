// The simplex of the algorithm of Gilbert, Johnson and Keerthi (IEEE J. Robotics and Automation 4,
// 1988). It has up to four points of the Minkowski difference B - A, and the point of their hull
// that is closest to the origin. T is the number type: double, or DoubleDouble where simplices are
// slender.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "core/numerics/double_double.hpp"
#include "core/vec.hpp"

namespace clearance {

template <class T>
struct Vector {
  T x{}, y{}, z{};

  friend Vector operator+(const Vector& a, const Vector& b) noexcept {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend Vector operator-(const Vector& a, const Vector& b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend Vector operator*(const T& s, const Vector& v) noexcept {
    return {s * v.x, s * v.y, s * v.z};
  }
  friend T dot(const Vector& a, const Vector& b) noexcept {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
  friend Vector cross(const Vector& a, const Vector& b) noexcept {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
};

template <class T>
[[nodiscard]] Vector<T> vector_of(const Vec3& v) noexcept {
  return {v.x(), v.y(), v.z()};
}
template <class T>
[[nodiscard]] Vec3 rounded(const Vector<T>& v) noexcept {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

[[nodiscard]] inline double leading(double x) noexcept { return x; }
[[nodiscard]] inline double leading(const DoubleDouble& x) noexcept { return x.high; }

template <class T>
struct ClosestPoint {
  Vector<T> point;             // of the simplex, closest to the origin
  std::array<T, 4> weights{};  // of its vertices, >= 0, sum 1; 0 for those that are not needed
  T length2{};                 // |point|^2
};

// Barycentric coordinates of the origin's projection on the affine hull of one to four points, by
// Cramer's rule; those of other points stay 0. Returns false if the points are affinely dependent;
// a smaller subset then has the closest point.
template <class T>
[[nodiscard]] bool projection_weights(const std::array<Vector<T>, 4>& p,
                                      const std::array<std::size_t, 4>& at, std::size_t count,
                                      std::array<T, 4>& w) noexcept {
  const Vector<T>&a = p[at[0]], &b = p[at[1]], &c = p[at[2]], &d = p[at[3]];
  if (count == 1) {
    w[at[0]] = 1.0;
    return true;
  }
  if (count == 2) {
    const Vector<T> u = b - a;
    const T uu = dot(u, u);
    if (!(leading(uu) > 0.0)) return false;
    const T t = -dot(a, u) / uu;
    w[at[0]] = T(1.0) - t;
    w[at[1]] = t;
    return true;
  }
  if (count == 3) {
    // Areas of the triangles that the origin's projection makes with the edges, over the whole.
    const Vector<T> n = cross(b - a, c - a);
    const T nn = dot(n, n);
    if (!(leading(nn) > 0.0)) return false;
    w[at[0]] = dot(n, cross(b, c)) / nn;
    w[at[1]] = dot(n, cross(c, a)) / nn;
    w[at[2]] = T(1.0) - w[at[0]] - w[at[1]];
    return true;
  }
  // Signed volumes that the origin makes with the faces, over the whole (each six times too large).
  const T volume = dot(b - a, cross(c - a, d - a));
  if (leading(volume) == 0.0) return false;
  w[at[0]] = dot(b, cross(c, d)) / volume;
  w[at[1]] = -dot(a, cross(c, d)) / volume;
  w[at[2]] = dot(a, cross(b, d)) / volume;
  w[at[3]] = T(1.0) - w[at[0]] - w[at[1]] - w[at[2]];  // the rest of a thin one's volume
  return true;
}

// Tries all subsets and takes the closest projection that lies within its subset's hull. The first
// `reduced` points are known to be all needed for their own closest point: their subsets are left
// out, which leaves 9 of 15 where one point is new.
//
// Johnson's recursion decides by the signs of determinants which subset it is. If rounding changes
// a sign, the recursion ends at the wrong subset or at none. The least length, however, is off by
// rounding at most. points[0, size) may be any, degenerate simplices included.
template <class T>
[[nodiscard]] ClosestPoint<T> closest_to_origin(const std::array<Vector<T>, 4>& points,
                                                std::size_t size,
                                                std::size_t reduced = 0) noexcept {
  ClosestPoint<T> best;
  best.length2 = std::numeric_limits<double>::infinity();
  const unsigned first = reduced == 0 ? 1u : (1u << reduced) - 1;
  for (unsigned subset = first; subset < (1u << size); ++subset) {
    std::array<std::size_t, 4> at{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < size; ++i) {
      if (subset & (1u << i)) at[count++] = i;
    }
    std::array<T, 4> w{};
    if (!projection_weights(points, at, count, w)) continue;
    bool within = true;
    Vector<T> v;
    for (std::size_t i = 0; i < size; ++i) {
      within = within && !(leading(w[i]) < 0.0);
      v = v + w[i] * points[i];
    }
    const T length2 = dot(v, v);
    if (within && length2 < best.length2) best = {v, w, length2};
  }
  return best;
}

// Point has a member `difference`, a Vector<T>, and operator==, which recognises a point that is
// present already.
template <class Point, class T>
class Simplex {
 public:
  // False: the simplex has this point already, and no progress is possible.
  [[nodiscard]] bool add(const Point& point) noexcept {
    for (std::size_t i = 0; i < size_; ++i) {
      if (points_[i] == point) return false;
    }
    points_[size_++] = point;
    return true;
  }
  // Keeps the points that the closest point needs, and returns it.
  ClosestPoint<T> reduce() noexcept {
    std::array<Vector<T>, 4> differences;
    for (std::size_t i = 0; i < size_; ++i) differences[i] = points_[i].difference;
    const ClosestPoint<T> closest = closest_to_origin(differences, size_, reduced_);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      if (!(leading(closest.weights[i]) > 0.0)) continue;
      points_[kept] = points_[i];
      weights_[kept++] = static_cast<double>(closest.weights[i]);
    }
    size_ = reduced_ = kept;
    return closest;
  }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool holds_origin() const noexcept { return size_ == 4; }
  [[nodiscard]] const Point& point(std::size_t i) const noexcept { return points_[i]; }
  // The closest point's mean of `part`(point).
  template <class Part>
  [[nodiscard]] Vec3 mean(Part part) const noexcept {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < size_; ++i) sum += weights_[i] * part(points_[i]);
    return sum;
  }

 private:
  std::array<Point, 4> points_{};
  std::array<double, 4> weights_{};
  std::size_t size_ = 0;
  std::size_t reduced_ = 0;  // the points that the last reduce() kept
};

}  // namespace clearance
