#include "tools/bench/bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <variant>

namespace clearance::bench {
namespace {

constexpr double kPi = std::numbers::pi;

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

std::vector<HalfSpace> ball_rows(int order) {
  std::vector<HalfSpace> rows;
  for (const Vec3& d : even_directions(order)) rows.push_back({d, 1.0});
  return rows;
}

ConvexBody ball(char kind, int order) {
  return std::get<ConvexBody>(kind == 'v' ? polyhedron_from_vertices(even_directions(order))
                                          : polyhedron_from_halfspaces(ball_rows(order)));
}

ConvexBody random_box(Random& random) {
  const double x = random.uniform(0.05, 0.5), y = random.uniform(0.05, 0.5);
  return std::get<ConvexBody>(box({x, y, random.uniform(0.05, 0.5)}));
}

ConvexBody random_link(Random& random, int around) {
  const double length = random.uniform(0.2, 0.5);
  const double start = random.uniform(0.05, 0.09), end = random.uniform(0.04, 0.07);
  const std::array<Eigen::Vector2d, 4> rings{{{-0.5 * length - 0.4 * start, 0.7 * start},
                                              {-0.5 * length, start},
                                              {0.5 * length, end},
                                              {0.5 * length + 0.4 * end, 0.7 * end}}};
  std::vector<Vec3> points;
  for (const Eigen::Vector2d& ring : rings) {
    for (int k = 0; k < around; ++k) {
      const double angle = 2.0 * kPi * k / around;
      points.emplace_back(ring.y() * std::cos(angle), ring.y() * std::sin(angle), ring.x());
    }
  }
  return std::get<ConvexBody>(polyhedron_from_vertices(points));
}

}  // namespace clearance::bench
