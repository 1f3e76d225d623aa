#include "tools/scene/query_time.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "core/distance.hpp"
#include "core/shapes.hpp"

namespace clearance {
namespace {

constexpr int kRounds = 15, kSteps = 3142;

std::vector<Pose> way_around(double size) {
  std::vector<Pose> poses(kSteps);
  for (int k = 0; k < kSteps; ++k) {
    const double t = 2.0 * std::numbers::pi * k / kSteps;
    const Vec3 way(std::cos(t), std::sin(t) * std::cos(2.0 * t), std::sin(t) * std::sin(2.0 * t));
    poses[static_cast<std::size_t>(k)].position = 2.5 * size * way;
    poses[static_cast<std::size_t>(k)].orientation =
        Eigen::Quaterniond(std::cos(t), 0.6 * std::sin(t), 0.0, 0.8 * std::sin(t));
  }
  return poses;
}

// Of one round, a query; the sum keeps the compiler from leaving the queries out.
double round_ns(const EnclosingModel& model, const ConvexPolyhedron& other,
                const std::vector<Pose>& poses, double& sum) {
  TrackingState state;
  const auto start = std::chrono::steady_clock::now();
  for (const Pose& pose : poses) {
    sum += distance(model.shape, other, model.frame_from_shape, pose, state).distance;
  }
  const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
  return took.count() / static_cast<double>(poses.size());
}

}  // namespace

std::vector<double> query_times(std::span<const EnclosingModel> models) {
  double size = 0.0;
  for (const EnclosingModel& model : models) {
    const double reach = model.frame_from_shape.position.norm() + model.shape.bounding_radius;
    size = std::max(size, reach + model.shape.radius);
  }
  const auto other = std::get<ConvexPolyhedron>(box(Vec3::Constant(0.25 * size)));
  const std::vector<Pose> poses = way_around(size);
  std::vector<std::vector<double>> rounds(models.size());
  double sum = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < models.size(); ++i) {
      rounds[i].push_back(round_ns(models[i], other, poses, sum));
    }
  }
  std::vector<double> medians;
  for (std::vector<double>& of_model : rounds) {
    std::nth_element(of_model.begin(), of_model.begin() + kRounds / 2, of_model.end());
    medians.push_back(std::isfinite(sum) ? of_model[kRounds / 2] : kInfinity);
  }
  return medians;
}

}  // namespace clearance
