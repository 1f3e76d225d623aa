#include "core/curved/start.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace clearance {
namespace {

constexpr int kRounds = 24;

using Weights = std::array<double, 4>;

// The point nearest to the origin of the hull of up to four points, as weights >= 0 of sum 1: the
// nearest of those of all faces that hold the newest point, which is last. In doubles: weights that
// are a little off give points a little farther away, which are still points of the bodies.
class NearestOfSimplex {
 public:
  NearestOfSimplex(const std::array<Vec3, 4>& points, std::size_t size) noexcept
      : p_(points), last_(size - 1) {
    take({last_}, {1.0});
    for (std::size_t i = 0; i < last_; ++i) {
      edge(i);
      for (std::size_t j = 0; j < i; ++j) triangle(i, j);
    }
    if (size == 4) tetrahedron();
  }
  [[nodiscard]] const Weights& weights() const noexcept { return best_; }

 private:
  template <std::size_t N>
  void take(const std::size_t (&at)[N], const double (&weights)[N]) noexcept {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < N; ++i) {
      if (!(weights[i] > 0.0)) return;
      sum += weights[i] * p_[at[i]];
    }
    const double square = sum.squaredNorm();
    if (!(square < least_)) return;
    least_ = square;
    best_ = {};
    for (std::size_t i = 0; i < N; ++i) best_[at[i]] = weights[i];
  }
  void edge(std::size_t i) noexcept {
    const Vec3 u = p_[i] - p_[last_];
    const double part = -p_[last_].dot(u) / u.squaredNorm();
    take({last_, i}, {1.0 - part, part});
  }
  void triangle(std::size_t i, std::size_t j) noexcept {
    const Vec3 &c = p_[last_], u = p_[i] - c, v = p_[j] - c;
    const Vec3 n = u.cross(v);
    const double square = n.squaredNorm();
    const double to_i = n.dot(v.cross(c)) / square, to_j = n.dot(c.cross(u)) / square;
    take({last_, i, j}, {1.0 - to_i - to_j, to_i, to_j});
  }
  void tetrahedron() noexcept {
    const Vec3 &d = p_[3], u = p_[0] - d, v = p_[1] - d, w = p_[2] - d;
    const double volume = u.dot(v.cross(w));
    const double a = -d.dot(v.cross(w)) / volume, b = -d.dot(w.cross(u)) / volume,
                 c = -d.dot(u.cross(v)) / volume;
    if (1.0 - a - b - c > 0.0 && a > 0.0 && b > 0.0 && c > 0.0) best_ = {a, b, c, 1.0 - a - b - c};
  }

  const std::array<Vec3, 4>& p_;
  std::size_t last_;
  Weights best_{};
  double least_ = kInfinity;
};

// Up to four points of B - A.
class CurvedSimplex {
 public:
  void add(const SupportPair& found) noexcept { points_[size_++] = found; }

  // Keeps what the point closest to the origin needs. True: the simplex holds the origin.
  [[nodiscard]] bool reduce(CurvedPair& pair, Vec3& closest) noexcept {
    std::array<Vec3, 4> differences;
    for (std::size_t i = 0; i < size_; ++i) differences[i] = points_[i].points.difference();
    const Weights weights = NearestOfSimplex(differences, size_).weights();
    PointPair mean;
    std::size_t kept = 0;
    closest = Vec3::Zero();
    for (std::size_t i = 0; i < size_; ++i) {
      if (!(weights[i] > 0.0)) continue;
      mean.a += weights[i] * points_[i].points.a;
      mean.own_b += weights[i] * points_[i].points.own_b;
      closest += weights[i] * differences[i];
      points_[kept++] = points_[i];
    }
    size_ = kept;
    (void)pair.add_points(mean.a, mean.own_b);
    return size_ == 4;
  }

  // Each once; of those that are kept when it does not hold the origin.
  [[nodiscard]] ActivePieces pieces() const noexcept {
    ActivePieces found;
    for (std::size_t i = 0; i < size_ && found.count < found.pieces.size(); ++i) {
      const auto end = found.pieces.begin() + static_cast<std::ptrdiff_t>(found.count);
      if (std::find(found.pieces.begin(), end, points_[i].pieces) != end) continue;
      found.pieces[found.count++] = points_[i].pieces;
    }
    return found;
  }

 private:
  std::array<SupportPair, 4> points_{};
  std::size_t size_ = 0;
};

}  // namespace

CurvedStart start_direction(CurvedPair& pair) noexcept {
  const Vec3 between = pair.point_to_a(Vec3::Zero());
  CurvedStart start;
  start.normal = unit_along(between);
  if (!(start.normal.norm() > 0.5)) start.normal = Vec3::UnitX();
  CurvedSimplex simplex;
  for (int round = 0; round < kRounds; ++round) {
    const SupportPair found = pair.support(start.normal);
    simplex.add(found);
    Vec3 closest;
    start.meet = simplex.reduce(pair, closest);
    if (pair.bounds.lower > 0.5 * pair.bounds.upper) break;
    const Vec3 next = unit_along(closest);
    if (start.meet || !(next.norm() > 0.5)) break;
    start.normal = next;
  }
  start.normal = pair.bounds.normal;
  start.pieces = simplex.pieces();
  return start;
}

}  // namespace clearance
