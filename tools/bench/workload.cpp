#include "tools/bench/workload.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <variant>

#include "core/shapes.hpp"

namespace clearance::bench {
namespace {

constexpr double kPi = std::numbers::pi;

// SplitMix64 (Steele, Lea, Flood 2014): the same numbers with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  Vec3 direction() {
    const double z = uniform(-1.0, 1.0), angle = uniform(0.0, 2.0 * kPi);
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

 private:
  double unit() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  std::uint64_t state_;
};

Eigen::Quaterniond turn(const Vec3& axis, double angle) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
}

// Uniform steps along a line and about an axis.
std::vector<Pose> drift(Random& random, const Vec3& middle, int steps) {
  const Vec3 along = random.direction(), axis = random.direction();
  const Eigen::Quaterniond start = turn(random.direction(), random.uniform(0.0, 2.0 * kPi));
  std::vector<Pose> poses;
  for (int k = 0; k < steps; ++k) {
    const Vec3 position = middle + 0.02 * (k - steps / 2) * along;
    poses.push_back({position, (turn(axis, 0.01 * k) * start).normalized()});
  }
  return poses;
}

double closest_centres(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  double least = kInfinity;
  for (std::size_t k = 0; k < a.size(); ++k) {
    least = std::min(least, (a[k].position - b[k].position).norm());
  }
  return least;
}

}  // namespace

std::vector<Vec3> even_directions(int order) {
  std::vector<Vec3> directions;
  for (int ring = 0; ring <= order; ++ring) {
    const double polar = kPi * ring / order;
    const int around = std::max(1, static_cast<int>(std::lround(2 * order * std::sin(polar))));
    const double radius = ring == 0 || ring == order ? 0.0 : std::sin(polar);
    for (int k = 0; k < around; ++k) {
      const double azimuth = 2.0 * kPi * k / around;
      directions.emplace_back(radius * std::cos(azimuth), radius * std::sin(azimuth),
                              std::cos(polar));
    }
  }
  return directions;
}

ConvexPolyhedron ball(char kind, int order) {
  const std::vector<Vec3> directions = even_directions(order);
  if (kind == 'v') return std::get<ConvexPolyhedron>(polyhedron_from_vertices(directions));
  std::vector<HalfSpace> rows;
  for (const Vec3& d : directions) rows.push_back({d, 1.0});
  return std::get<ConvexPolyhedron>(polyhedron_from_halfspaces(rows));
}

std::vector<Trajectory> trajectories(int count, int steps) {
  Random random(1);
  std::vector<Trajectory> all;
  while (static_cast<int>(all.size()) < count) {
    const std::vector<Pose> a = drift(random, Vec3::Zero(), steps);
    const std::vector<Pose> b = drift(random, random.uniform(2.6, 7.0) * random.direction(), steps);
    if (closest_centres(a, b) < 2.6) continue;
    Trajectory t;
    for (int k = 0; k < steps; ++k) t.poses.emplace_back(a[k], b[k]);
    all.push_back(std::move(t));
  }
  return all;
}

}  // namespace clearance::bench
