#include "tools/bench/thesis/chapter5/polyhedron_to_ellipsoid.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "core/active_set/alpha_step_length.hpp"
#include "core/active_set/lambda_multipliers.hpp"
#include "tools/bench/thesis/chapter5/safeguarded_newton.hpp"

namespace clearance::bench {
namespace {

Vec3 support(const Vec3& axes, const Vec3& direction) {
  const Vec3 scaled = axes.cwiseProduct(direction);
  return axes.cwiseProduct(scaled) / scaled.norm();
}

// 'Delta': the closest points of the active feature's affine hull and the ellipsoid, relative to
// its centre. If the feature is the inside, both are the ellipsoid's point nearest to x.
ClosestPoints delta_to_ellipsoid(const ActiveFeature& side, const Vec3& axes, const Vec3& centre) {
  const Vec3 x = side.point_A() - centre;
  if (side.feature() == FeatureKind::kFacet) {
    return plane_to_ellipsoid(side.facet().normal,
                              side.facet().offset - side.facet().normal.dot(centre), axes);
  }
  if (side.feature() == FeatureKind::kEdge) {
    return line_to_ellipsoid({x, side.edge().direction}, axes);
  }
  const Vec3 nearest = nearest_by_newton<3>(axes, x).point;
  return {side.feature() == FeatureKind::kVertex ? x : nearest, nearest};
}

}  // namespace

ClosestPoints line_to_ellipsoid(const Line& line, const Vec3& axes) {
  const Vec3& l = line.direction;
  const Vec3 origin = line.point - line.point.dot(l) * l;
  // The first normal points to the line; if that passes through the centre, it is any normal across
  // the line.
  const double away = origin.norm();
  const Vec3 normal_a = away > 1e-12 * axes.minCoeff() ? Vec3(origin / away) : l.unitOrthogonal();
  const Vec3 x_a = support(axes, normal_a);
  // (5.5.3), (5.5.4): the normal of x_b is across the line and across x_a.
  const Vec3 x_b = support(axes, x_a.cross(l));

  // Both in the plane across the line, in coordinates along normal_a and across it.
  const Vec3 across = l.cross(normal_a);
  Eigen::Matrix2d spanned;
  spanned << x_a.dot(normal_a), x_b.dot(normal_a), x_a.dot(across), x_b.dot(across);
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(spanned, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector2d semi = svd.singularValues();
  const Eigen::Vector2d p = svd.matrixU().transpose() * Eigen::Vector2d(origin.dot(normal_a), 0.0);
  const bool through = p.cwiseQuotient(semi).squaredNorm() <= 1.0;
  const Eigen::Vector2d q = through ? p : nearest_by_newton<2>(semi, p).point;

  // Back onto the surface, or into the ellipsoid, in the plane of the ellipse.
  const Eigen::Vector2d angle = svd.matrixV() * q.cwiseQuotient(semi);
  const Vec3 on_b = angle.x() * x_a + angle.y() * x_b;
  return {origin + on_b.dot(l) * l, on_b};
}

ClosestPoints plane_to_ellipsoid(const Vec3& normal, double offset, const Vec3& axes) {
  const double support_value = axes.cwiseProduct(normal).norm();
  if (std::abs(offset) <= support_value) {  // through it: the centre of the section
    const Vec3 middle =
        offset / (support_value * support_value) * axes.cwiseAbs2().cwiseProduct(normal);
    return {middle, middle};
  }
  const Vec3 on_b = support(axes, offset > 0.0 ? normal : Vec3(-normal));
  return {on_b + (offset - normal.dot(on_b)) * normal, on_b};
}

ClosestPoints polyhedron_to_ellipsoid(const ConvexBody& a, const Vec3& axes, const Vec3& apart) {
  constexpr int kMostCycles = 1000;
  // A release that gains less than this share of the distance is no gain.
  constexpr double kRate = 1e-12;
  ActiveFeature side(a, nullptr);
  side.place_inside(a.interior);
  ClosestPoints found;
  while (found.rounds < kMostCycles) {
    ++found.rounds;
    const Vec3 move = delta_to_ellipsoid(side, axes, apart).on_a + apart - side.point_A();
    const Alpha step = alpha(side, move);
    advance(side, move, step);
    if (step.blocking != kNone) continue;
    found.on_a = side.point_A();
    found.on_b = apart + nearest_by_newton<3>(axes, found.on_a - apart).point;
    const Vec3 towards = found.on_b - found.on_a;
    const Lambda release = lambda(side, towards);
    if (!(release.derivative > kRate * towards.norm())) return found;
    side.place(release.to, release.index, side.point_L());
  }
  found.converged = false;
  return found;
}

}  // namespace clearance::bench
