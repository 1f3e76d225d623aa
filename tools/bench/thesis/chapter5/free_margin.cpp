#include "tools/bench/thesis/chapter5/free_margin.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/convex_body.hpp"

namespace clearance::bench {
namespace {

// The z of unit length that minimises |c + H^(1/2) z|, with H = diag(h). It solves (H - l I) z =
// -g, where g = H^(1/2) c and l is the least real eigenvalue of [H -I; -g g' H]. The paper's
// formula is from W. Gander, G. Golub, U. von Matt, "A constrained eigenvalue problem", 1989.
Vec3 nearest_of_sphere(const Vec3& h, const Vec3& g) {
  Eigen::Matrix<double, 6, 6> m;
  m << Mat3(h.asDiagonal()), -Mat3::Identity(), -g * g.transpose(), Mat3(h.asDiagonal());
  const auto values = Eigen::EigenSolver<Eigen::Matrix<double, 6, 6>>(m, false).eigenvalues();
  double least = kInfinity;
  for (const auto& value : values) {
    if (std::abs(value.imag()) <= 1e-9 * std::abs(value)) least = std::min(least, value.real());
  }
  return -g.cwiseQuotient((h.array() - least).matrix());
}

}  // namespace

// Coordinates are scaled so that A is the unit sphere. The axes are parallel, so B then has the
// semi-axes b_i / a_i and the centre c_i / a_i. The first step finds the point of B nearest to the
// origin there, the second the point of A nearest to that point.
FreeMargin free_margin(const EllipsoidPair& pair) {
  const Vec3 ratios = pair.axes_b.cwiseQuotient(pair.axes_a);
  const Vec3 centre = pair.apart.cwiseQuotient(pair.axes_a);
  const Vec3 z = nearest_of_sphere(ratios.cwiseAbs2(), ratios.cwiseProduct(centre));
  const Vec3 scaled = centre + ratios.cwiseProduct(z);
  const Vec3 touched = pair.axes_a.cwiseProduct(scaled);
  const Vec3 y = nearest_of_sphere(pair.axes_a.cwiseAbs2(), -pair.axes_a.cwiseProduct(touched));
  return {scaled.norm() - 1.0, touched, pair.axes_a.cwiseProduct(y)};
}

}  // namespace clearance::bench
