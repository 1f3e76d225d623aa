#include "tools/bench/thesis/chapter5/facet_ball.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "core/shapes.hpp"

namespace clearance::bench {

std::vector<Vec3> facet_ball_directions(int order) {
  constexpr double kPi = std::numbers::pi;
  std::vector<Vec3> directions{-Vec3::UnitX()};
  for (int ring = 1; ring <= order; ++ring) {
    const double polar = kPi * ring / order;
    const double radius = ring == order ? 0.0 : std::sin(polar);
    const int around = std::max(1, static_cast<int>(std::lround(2 * order * radius)));
    const double first = ring % 2 == 0 ? kPi / around : 0.0;
    for (int k = 0; k < around; ++k) {
      const double azimuth = first + 2.0 * kPi * k / around;
      directions.emplace_back(-std::cos(polar), -radius * std::sin(azimuth),
                              -radius * std::cos(azimuth));
    }
  }
  return directions;
}

ConvexBody ellipsoid_model(const Vec3& axes, int order) {
  std::vector<HalfSpace> rows;
  for (const Vec3& n : facet_ball_directions(order)) {
    rows.push_back({n, axes.cwiseProduct(n).norm()});
  }
  return std::get<ConvexBody>(polyhedron_from_halfspaces(rows));
}

FacetBallPair::FacetBallPair(const EllipsoidPair& pair, int order)
    : a_(ellipsoid_model(pair.axes_a, order)), b_(ellipsoid_model(pair.axes_b, order)) {}

}  // namespace clearance::bench
