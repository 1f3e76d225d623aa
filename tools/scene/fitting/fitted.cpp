#include "tools/scene/fitting/fitted.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/model/rotation_between.hpp"
#include "tools/scene/fitting/certified_error.hpp"

namespace clearance {
namespace {

// Steps of the search, rad. The last one moves a link's surface by less than a thousandth of its
// size.
constexpr double kFirstStep = 0.6, kLastStep = 1e-4;
// Directions of a step. Costs have kinks, so that each of a few directions may lead upwards
// although one between them leads downwards.
constexpr int kStepDirections = 16;

}  // namespace

double size_of(const ConvexBody& body) {
  double size = 0.0;
  for (const Vec3& p : body.anchors) size = std::max(size, p.cwiseAbs().maxCoeff());
  return size;
}

std::vector<Vec3> vertices_in(const ConvexBody& body, const Eigen::Quaterniond& body_from_frame) {
  const Mat3 to_frame = rotation_matrix(body_from_frame).transpose();
  std::vector<Vec3> placed;
  placed.reserve(body.anchors.size());
  for (const Vec3& p : body.anchors) placed.emplace_back(to_frame * p);
  return placed;
}

Eigen::Quaterniond rotation_to(const Vec3& axis) {
  return rotation_between(Vec3::UnitZ(), axis).normalized();
}

Mat3 principal_axes(const ConvexBody& body) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : body.anchors) mean += p;
  mean /= static_cast<double>(body.anchors.size());
  Mat3 spread = Mat3::Zero();
  for (const Vec3& p : body.anchors) spread += (p - mean) * (p - mean).transpose();
  return Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors();
}

Vec3 best_direction(std::span<const Vec3> starts, const std::function<double(const Vec3&)>& cost) {
  Vec3 best = starts[0];
  double least = kInfinity;
  for (const Vec3& start : starts) {
    Vec3 at = start;
    double here = cost(at);
    for (double step = kFirstStep; step > kLastStep;) {
      const Vec3 x = at.unitOrthogonal(), y = at.cross(x);
      Vec3 next = at;
      double lower = here;
      for (int k = 0; k < kStepDirections; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / kStepDirections;
        const Vec3 sideways = std::cos(angle) * x + std::sin(angle) * y;
        const Vec3 tried = (at + step * sideways).normalized();
        const double there = cost(tried);
        if (there < lower) {
          lower = there;
          next = tried;
        }
      }
      if (lower < here) {
        at = next;
        here = lower;
      } else {
        step *= 0.5;
      }
    }
    if (here < least) {
      least = here;
      best = at;
    }
  }
  return best;
}

EnclosingModel fitted(ModelKind kind, ShapeResult shape, const Pose& frame_from_shape,
                      const ConvexBody& body) {
  if (const auto* error = std::get_if<ShapeError>(&shape)) throw std::logic_error(error->reason);
  EnclosingModel model{kind, std::get<ConvexBody>(std::move(shape)), frame_from_shape};
  const PlacedShape placed[] = {{&body, Pose{}}};
  model.error = certified_error(model.shape, model.frame_from_shape, placed);
  return model;
}

}  // namespace clearance
