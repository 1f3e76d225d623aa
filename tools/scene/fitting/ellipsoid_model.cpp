// The ellipsoid of least volume, by Khachiyan's method with steps away (M. J. Todd and E. A.
// Yildirim, "On Khachiyan's algorithm for the computation of minimum-volume enclosing ellipsoids",
// 2007).
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/scene/fitting/fitted.hpp"

namespace clearance {
namespace {

using Lifted = Eigen::Matrix<double, 4, 1, Eigen::DontAlign>;
using LiftedMatrix = Eigen::Matrix<double, 4, 4, Eigen::DontAlign>;

constexpr double kDimension = 3.0;
constexpr double kOptimal =
    1e-5;  // share of kDimension + 1; the volume is then within 1e-4 of the least
constexpr int kSteps = 20000;

// Weights of the points. The ellipsoid's centre and matrix are their mean and covariance.
std::vector<double> weights_of(const std::vector<Vec3>& points) {
  const std::size_t count = points.size();
  std::vector<double> weights(count, 1.0 / static_cast<double>(count)), values(count);
  for (int step = 0; step < kSteps; ++step) {
    LiftedMatrix moments = LiftedMatrix::Zero();
    for (std::size_t i = 0; i < count; ++i) {
      const Lifted q(points[i].x(), points[i].y(), points[i].z(), 1.0);
      moments += weights[i] * q * q.transpose();
    }
    const LiftedMatrix inverse = moments.inverse();
    std::size_t most = 0, least = count;
    for (std::size_t i = 0; i < count; ++i) {
      const Lifted q(points[i].x(), points[i].y(), points[i].z(), 1.0);
      values[i] = q.dot(inverse * q);
      if (values[i] > values[most]) most = i;
      if (weights[i] > 0.0 && (least == count || values[i] < values[least])) least = i;
    }
    const double above = values[most] - kDimension - 1.0, below = kDimension + 1.0 - values[least];
    if (std::max(above, below) <= kOptimal * (kDimension + 1.0)) break;
    const std::size_t moved = above >= below ? most : least;
    double by = (values[moved] - kDimension - 1.0) / ((kDimension + 1.0) * (values[moved] - 1.0));
    const double away = weights[moved] < 1.0 ? -weights[moved] / (1.0 - weights[moved]) : 0.0;
    by = std::max(by, away);
    for (double& w : weights) w *= 1.0 - by;
    weights[moved] = by == away ? 0.0 : weights[moved] + by;
  }
  return weights;
}

}  // namespace

EnclosingModel enclosing_ellipsoid(const ConvexBody& body) {
  // The unit of each principal axis is its extent, so that thin bodies are as well conditioned as
  // others.
  const Eigen::Quaterniond rotation = [&] {
    Mat3 axes = principal_axes(body);
    if (axes.determinant() < 0.0) axes.col(0) *= -1.0;
    return Eigen::Quaterniond(axes).normalized();
  }();
  std::vector<Vec3> points = vertices_in(body, rotation);
  Vec3 low = points[0], high = points[0];
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vec3 unit = 0.5 * (high - low), offset = 0.5 * (high + low);
  for (Vec3& p : points) p = (p - offset).cwiseQuotient(unit);
  const std::vector<double> weights = weights_of(points);
  Vec3 centre = Vec3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) centre += weights[i] * points[i];
  Mat3 spread = Mat3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    spread += kDimension * weights[i] * (points[i] - centre) * (points[i] - centre).transpose();
  }
  const Mat3 matrix = unit.asDiagonal() * spread * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(matrix);
  Mat3 axes = solver.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(0) *= -1.0;
  Pose at;
  at.orientation = (rotation * Eigen::Quaterniond(axes)).normalized();
  const Mat3 frame = rotation_matrix(at.orientation);
  at.position = rotation_matrix(rotation) * (unit.cwiseProduct(centre) + offset);
  const Vec3 semi_axes = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  double scale = 0.0;
  for (const Vec3& p : body.anchors) {
    const Vec3 local = frame.transpose() * (p - at.position);
    scale = std::max(scale, local.cwiseQuotient(semi_axes).norm());
  }
  // Enlarges the ellipsoid by a margin against rounding. A vertex rounds in proportion to the size
  // of the body, so the relative margin must be larger the thinner the ellipsoid is.
  const double thinnest = semi_axes.minCoeff();
  scale *= 1.0 + 4.0 * kFittingMargin * (1.0 + size_of(body) / thinnest);
  return fitted(ModelKind::kEllipsoid, ellipsoid(scale * semi_axes), at, body);
}

}  // namespace clearance
