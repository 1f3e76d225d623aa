#include "core/curved/start.hpp"

#include <algorithm>

#include "core/gjk/closest_on_simplex.hpp"

namespace clearance {
namespace {

constexpr int kRounds = 24;

// Up to four points of B - A.
class CurvedSimplex {
 public:
  void add(const PointPair& points) noexcept { points_[size_++] = points; }

  // Keeps what the point closest to the origin needs. True: the simplex holds the origin.
  [[nodiscard]] bool reduce(CurvedPair& pair, Vec3& closest) noexcept {
    std::array<WideVec, 4> differences;
    for (std::size_t i = 0; i < size_; ++i) differences[i] = wide(points_[i].difference());
    const ClosestPoint found = closest_to_origin(differences, size_);
    Vec3 on_a = Vec3::Zero(), own_b = Vec3::Zero();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const auto weight = static_cast<double>(found.weights[i]);
      if (!(weight > 0.0)) continue;
      on_a += weight * points_[i].a;
      own_b += weight * points_[i].own_b;
      points_[kept++] = points_[i];
    }
    size_ = kept;
    pair.add_points(on_a, own_b);
    closest = narrow(found.point);
    return size_ == 4;
  }

 private:
  std::array<PointPair, 4> points_;
  std::size_t size_ = 0;
};

}  // namespace

CurvedStart start_direction(CurvedPair& pair) noexcept {
  const Vec3 between = pair.point_to_a(Vec3::Zero());
  CurvedStart start{unit_along(between)};
  if (!(start.normal.norm() > 0.5)) start.normal = Vec3::UnitX();
  CurvedSimplex simplex;
  for (int round = 0; round < kRounds; ++round) {
    const SupportPair found = pair.support(start.normal);
    if (pair.bounds.lower > 0.5 * pair.bounds.upper) break;
    simplex.add(found.points);
    Vec3 closest;
    start.meet = simplex.reduce(pair, closest);
    const Vec3 next = unit_along(closest);
    if (start.meet || !(next.norm() > 0.5)) break;
    start.normal = next;
  }
  start.normal = pair.bounds.normal;
  return start;
}

}  // namespace clearance
